"""Other programs on the graph of a voxel model: TSP solvers for one closed strip, graph partitioners for equal piles.

    peers.py ZYGOTE MODEL.txt FOLDER

Prints two Markdown tables with what `zygote plan` does beside them. `cargo xtask bench stacking --peers` runs it.
"""

import json
import multiprocessing
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

SOLVER_TIMEOUT_S = 300
FAST_TSP_SECONDS = 5
PILES = (4, 8, 16)
# Corners of the six sides of a voxel, in order around the side.
SIDES = {
    (axis, high): [
        tuple({axis: high, (axis + 1) % 3: u, (axis + 2) % 3: v}[k] for k in range(3))
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))
    ]
    for axis, high in product(range(3), (0, 1))
}


def surface(text):
    """The squares that bound a voxel text: of each its voxel and its corners in order."""
    slices = [part.split() for part in text.split("\n\n") if part.strip()]
    solid = {
        (x, y, z)
        for z, rows in enumerate(slices)
        for y, row in enumerate(rows)
        for x, mark in enumerate(row)
        if mark == "#"
    }
    squares = []
    for voxel in sorted(solid):
        for (axis, high), corners in SIDES.items():
            beyond = list(voxel)
            beyond[axis] += 2 * high - 1
            if tuple(beyond) not in solid:
                squares.append((voxel, [tuple(map(sum, zip(voxel, corner))) for corner in corners]))
    return squares


def dual(squares):
    """Neighbours of every square; where four meet at an edge, those of one voxel are neighbours."""
    meeting = {}
    for number, (_, corners) in enumerate(squares):
        for one, other in zip(corners, corners[1:] + corners[:1]):
            meeting.setdefault(frozenset((one, other)), []).append(number)
    near = [[] for _ in squares]
    for here in meeting.values():
        for a, b in product(here, here):
            if a != b and (len(here) == 2 or squares[a][0] == squares[b][0]):
                near[a].append(b)
    return near


def missing(order, near):
    """How many steps of a closed tour are no edges."""
    return sum(b not in near[a] for a, b in zip(order, order[1:] + order[:1]))


def matrix(near):
    rows = []
    for panel, beside in enumerate(near):
        row = [1] * len(near)
        for other in [panel, *beside]:
            row[other] = 0
        rows.append(row)
    return rows


def elkai_tour(near):
    import elkai

    return elkai.DistanceMatrix(matrix(near)).solve_tsp(runs=1)[:-1]


def fast_tsp_tour(near):
    import fast_tsp

    return fast_tsp.find_tour(matrix(near), duration_seconds=FAST_TSP_SECONDS)


def send(solve, near, pipe):
    pipe.send(solve(near))


def tour(solve, near):
    """A tour found in a process of its own, and the seconds that took; no tour where time ran out."""
    receiver, sender = multiprocessing.Pipe(duplex=False)
    worker = multiprocessing.Process(target=send, args=(solve, near, sender))
    begin = time.perf_counter()
    worker.start()
    sender.close()
    try:
        order = receiver.recv() if receiver.poll(SOLVER_TIMEOUT_S) else None
    except EOFError:
        order = None
    seconds = time.perf_counter() - begin
    worker.kill()
    worker.join()
    return order, seconds


def metis(near, piles):
    import pymetis

    return pymetis.part_graph(piles, adjacency=near, options=pymetis.Options(ufactor=1, seed=0))[1]


def kahip(near, piles):
    import kahip as library

    starts, ends = [0], []
    for beside in near:
        ends += beside
        starts.append(len(ends))
    strong = 2
    return library.kaffpa([1] * len(near), starts, [1] * len(ends), ends, piles, 0.0, True, 0, strong)[1]


def plan(zygote, model, folder, piles, options):
    """Runs `zygote plan` and reads the plan; gives what it said in place of a plan where it made none."""
    file = folder / "peer.fold"
    begin = time.perf_counter()
    command = [zygote, "plan", model, "--piles", str(piles), "--output", file, *options]
    done = subprocess.run(command, capture_output=True, text=True)
    seconds = time.perf_counter() - begin
    return (json.loads(file.read_text()) if done.returncode == 0 else done.stderr.strip()), seconds


def piles_of(file, squares):
    """The squares of every pile, read from a plan."""
    number = {frozenset(corners): index for index, (_, corners) in enumerate(squares)}
    points = [tuple(point) for point in file["vertices_coords"]]
    panels = [number[frozenset(points[vertex] for vertex in face)] for face in file["faces_vertices"]]
    return [[panels[index] for index in pile["panels"]] for pile in file["zygote:piles"]]


def parts_of(file, squares):
    """The pile of every square, read from a plan."""
    return [pile for _, pile in sorted((s, pile) for pile, row in enumerate(piles_of(file, squares)) for s in row)]


def line(name, piles, parts, near, seconds):
    cut = sum(parts[a] != parts[b] for a, beside in enumerate(near) for b in beside) // 2
    sizes = [parts.count(part) for part in range(piles)]
    print(f"| {name} | {piles} | {cut} | {min(sizes)} to {max(sizes)} | {seconds:.3f} |", flush=True)


def main(zygote, model, folder):
    squares = surface(Path(model).read_text())
    near = dual(squares)
    folder = Path(folder)
    print(f"\nOne closed strip of {Path(model).name}, {len(near)} panels:\n")
    print("| program | seconds | edges missing |\n|---|---|---|")
    file, seconds = plan(zygote, model, folder, 1, [])
    if isinstance(file, dict):
        lost = missing(piles_of(file, squares)[0], near)
        print(f"| `zygote plan`, whole | {seconds:.3f} | {lost} |", flush=True)
    else:
        print(f"| `zygote plan`, whole | {seconds:.3f} | {file} |", flush=True)
    for name, solve in (("fast-tsp", fast_tsp_tour), ("elkai (LKH)", elkai_tour)):
        order, seconds = tour(solve, near)
        lost = f"none found within {SOLVER_TIMEOUT_S} s" if order is None else missing(order, near)
        print(f"| {name} | {seconds:.1f} | {lost} |", flush=True)
    print("\nEqual piles (the peers cut the graph and no more; parts need not have a strip):\n")
    print("| program | K | cut | sizes | seconds |\n|---|---|---|---|---|")
    ways = {"`zygote plan`, whole": []}
    if "--partition" in subprocess.run([zygote, "plan", "--help"], capture_output=True, text=True).stdout:
        ways = {f"`zygote plan --partition {way}`, whole": ["--partition", way] for way in ("mincut", "arcs")}
    for piles in PILES:
        for name, options in ways.items():
            file, seconds = plan(zygote, model, folder, piles, options)
            if isinstance(file, dict):
                line(name, piles, parts_of(file, squares), near, seconds)
            else:
                print(f"| {name} | {piles} | {file} | | {seconds:.3f} |", flush=True)
        for name, solve in (("METIS (pymetis)", metis), ("KaHIP strong", kahip)):
            begin = time.perf_counter()
            parts = list(solve(near, piles))
            line(name, piles, parts, near, time.perf_counter() - begin)


if __name__ == "__main__":
    main(*sys.argv[1:])
