#!/usr/bin/env python3
"""Writes the meshes of this folder that are not drawn by hand: `python3 models/make_meshes.py`. Needs nothing but Python."""

from math import cos, pi, sin, sqrt
from pathlib import Path

HERE = Path(__file__).parent


def ball(centre, radii, around=20, along=12, lift=(0, 0)):
    """A closed ellipsoid of quads and triangles, long in x, outer side out; `lift` bends it up by x and by x squared."""
    points, faces = [(-1, 0, 0)], []
    for i in range(1, along):
        a = pi * i / along
        points += [(-cos(a), sin(a) * cos(b), sin(a) * sin(b)) for b in (2 * pi * j / around for j in range(around))]
    points.append((1, 0, 0))
    ring = lambda i, j: 1 + (i - 1) * around + j % around
    for j in range(around):
        faces.append((0, ring(1, j + 1), ring(1, j)))
        for i in range(1, along - 1):
            faces.append((ring(i, j), ring(i, j + 1), ring(i + 1, j + 1), ring(i + 1, j)))
        faces.append((ring(along - 1, j), ring(along - 1, j + 1), len(points) - 1))
    bend = lambda x: lift[0] * x + lift[1] * x * x
    place = lambda p: [c + r * q for c, r, q in zip(centre, radii, p)]
    placed = [place(p) for p in points]
    return [(x, y, z + bend(p[0])) for (x, y, z), p in zip(placed, points)], faces


def plate(outline, thickness, lift=0.0):
    """A flat plate from a convex outline in x and y, counter-clockwise; `lift` tilts it up along y."""
    n = len(outline)
    points = [(x, y, z + lift * abs(y)) for z in (-thickness / 2, thickness / 2) for x, y in outline]
    faces = [tuple(reversed(range(n))), tuple(range(n, 2 * n))]
    faces += [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return points, faces


def together(*shells):
    """Shells that may overlap, as one mesh."""
    points, faces = [], []
    for shell_points, shell_faces in shells:
        faces += [tuple(c + len(points) for c in face) for face in shell_faces]
        points += shell_points
    return points, faces


def mirrored(shell):
    points, faces = shell
    return [(x, -y, z) for x, y, z in points], [tuple(reversed(face)) for face in faces]


def standing(shell):
    """Turned about x, so that y becomes z."""
    points, faces = shell
    return [(x, -z, y) for x, y, z in points], faces


def bird():
    """Body, neck, head, beak, tail and two thin wings."""
    wing = plate([(-1.2, 0.2), (1.5, 0.2), (0.9, 5.2), (-0.2, 6.0), (-0.9, 5.0)], 0.35, lift=0.35)
    return together(
        ball((0, 0, 0), (3.2, 1.3, 1.3), lift=(0.2, 0.1)),
        ball((3.0, 0, 0.9), (1.2, 0.6, 0.7), lift=(0.5, 0)),
        ball((4.1, 0, 1.7), (0.85, 0.75, 0.75)),
        ball((5.2, 0, 1.7), (0.8, 0.22, 0.2), around=12, along=8),
        ball((-3.6, 0, 0.0), (1.8, 1.0, 0.35), lift=(-0.2, 0)),
        wing,
        mirrored(wing),
    )


def knot(along=160, around=12, radius=0.85):
    """A trefoil knot: a tube of genus 1."""
    curve = lambda t: (sin(t) + 2 * sin(2 * t), cos(t) - 2 * cos(2 * t), -1.3 * sin(3 * t))
    minus = lambda p, q: tuple(a - b for a, b in zip(p, q))
    unit = lambda v: tuple(c / sqrt(sum(d * d for d in v)) for c in v)
    cross = lambda u, v: (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    points, faces = [], []
    for i in range(along):
        t = 2 * pi * i / along
        here, ahead = curve(t), unit(minus(curve(t + 1e-4), curve(t - 1e-4)))
        side = unit(cross((0, 0, 1), ahead))
        up = cross(ahead, side)
        for j in range(around):
            a = 2 * pi * j / around
            points.append(tuple(2 * h + radius * (cos(a) * s + sin(a) * u) for h, s, u in zip(here, side, up)))
            at = lambda i, j: i % along * around + j % around
            faces.append((at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
    return points, faces


def airplane():
    """A fuselage with thin wings, stabilizers and fin."""
    wing = plate([(-1.5, 0.3), (1.6, 0.3), (-1.4, 9.0), (-2.6, 9.0)], 0.25, lift=0.08)
    stabilizer = plate([(-8.6, 0.1), (-6.8, 0.1), (-8.4, 3.2), (-9.2, 3.2)], 0.2)
    fin = standing(plate([(-8.8, 0.1), (-6.4, 0.1), (-8.6, 3.4), (-9.4, 3.4)], 0.2))
    engine = ball((0.6, 3.2, -0.5), (1.3, 0.5, 0.5), around=10, along=6)
    body = ball((0, 0, 0), (9.5, 1.1, 1.1), around=14, along=14)
    return together(body, wing, mirrored(wing), stabilizer, mirrored(stabilizer), fin, engine, mirrored(engine))


def bowl(around=16, along=6):
    """Half a sphere without a lid: a sheet, and no solid."""
    points, faces = [(0, 0, -3)], []
    for i in range(1, along + 1):
        a = pi / 2 * i / along
        points += [(3 * sin(a) * cos(b), 3 * sin(a) * sin(b), -3 * cos(a)) for b in (2 * pi * j / around for j in range(around))]
    ring = lambda i, j: 1 + (i - 1) * around + j % around
    for j in range(around):
        faces.append((0, ring(1, j + 1), ring(1, j)))
        faces += [(ring(i, j), ring(i, j + 1), ring(i + 1, j + 1), ring(i + 1, j)) for i in range(1, along)]
    return points, faces


def moebius(along=24):
    """A strip with half a twist."""
    points = []
    for i in range(along):
        t = 2 * pi * i / along
        for w in (-1, 1):
            r = 4 + w * cos(t / 2)
            points.append((r * cos(t), r * sin(t), w * sin(t / 2)))
    faces = [(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1) for i in range(along - 1)]
    return points, [*faces, (2 * along - 2, 1, 0, 2 * along - 1)]


def number(c):
    return f"{c:.3f}".rstrip("0").rstrip(".").replace("-0", "0") if abs(c) < 5e-4 else f"{c:.3f}".rstrip("0").rstrip(".")


def spaced(point):
    return " ".join(number(c) for c in point)


def write_obj(name, mesh):
    points, faces = mesh
    lines = [f"v {spaced(p)}" for p in points] + ["f " + " ".join(str(c + 1) for c in f) for f in faces]
    (HERE / name).write_text("\n".join(lines) + "\n")


def write_off(name, mesh):
    points, faces = mesh
    lines = ["OFF", f"{len(points)} {len(faces)} 0", *map(spaced, points)]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    (HERE / name).write_text("\n".join(lines) + "\n")


def write_stl(name, mesh):
    points, faces = mesh
    lines = [f"solid {Path(name).stem}"]
    for face in faces:
        for i in range(1, len(face) - 1):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += [f"vertex {spaced(points[c])}" for c in (face[0], face[i], face[i + 1])]
            lines += ["endloop", "endfacet"]
    (HERE / name).write_text("\n".join([*lines, f"endsolid {Path(name).stem}"]) + "\n")


if __name__ == "__main__":
    write_obj("bird.obj", bird())
    write_off("knot.off", knot())
    write_stl("airplane.stl", airplane())
    write_obj("bad/bowl.obj", bowl())
    write_off("bad/moebius.off", moebius())
