"""FCL on the poses that the example `motion_poses` writes: which cores meet, beside our verdicts.

    motions.py FOLDER

Prints Markdown tables. Exit code 1 where verdicts differ by more than a touch, or where FCL sees a collision deeper than
that in a motion that was certified free. `cargo xtask bench motion --peers` runs it.
"""

import json
import math
import sys
import time
from collections import Counter
from itertools import islice
from pathlib import Path

import fcl
import numpy as np

# So much of overlap, in panel lengths, is a touch: what lies on each other, rounding, and the allowance of 1e-6 that FCL
# itself makes across two edges.
TOUCH = 1e-6
# Pairs that are timed, at the most.
TIMED = 20_000
# What a plan's rows are added up by, where there are many small ones.
GROUP = "solid"
POSES = np.dtype([("pose", "<u4"), ("panel", "<u4"), ("frame", "<f8", (4, 3))])
PAIRS = np.dtype([("pose", "<u4"), ("a", "<u4"), ("b", "<u4"), ("gap", "<f8")])
PLAIN = fcl.CollisionRequest()
DEEP = fcl.CollisionRequest(num_max_contacts=16, enable_contact=True)


def depth_of(one, other):
    """How deep two objects are in each other, as FCL has it; none where it says that they don't meet."""
    if not fcl.collide(one, other, PLAIN, fcl.CollisionResult()):
        return None
    result = fcl.CollisionResult()
    fcl.collide(one, other, DEEP, result)
    # What touches exactly it calls a collision when nothing more is asked, and finds no point of contact.
    return max((contact.penetration_depth for contact in result.contacts), default=0.0)


class Plates:
    """A plan's cores as objects of FCL, put where a pose has them."""

    def __init__(self, folder, head):
        self.poses = np.fromfile(folder / f"{head['name']}.poses", dtype=POSES)
        self.ends = np.searchsorted(self.poses["pose"], np.arange(head["poses"] + 1))
        sides = [2 * half for half in head["half"]]
        # Every panel its own shape: contacts name shapes, not objects.
        self.shapes = [fcl.Box(*sides) for _ in range(head["panels"])]
        self.objects = [fcl.CollisionObject(shape) for shape in self.shapes]
        self.panel_of = {id(shape): panel for panel, shape in enumerate(self.shapes)}

    def place(self, pose):
        """Moves what isn't where the pose before had it."""
        for _, panel, (centre, *axes) in self.poses[self.ends[pose] : self.ends[pose + 1]]:
            self.objects[panel].setTransform(fcl.Transform(np.column_stack(axes), centre))

    def all_meetings(self, manager):
        """Every two panels that meet, found by FCL's own tree of boxes, and how deep."""
        manager.update()
        found = {}

        def look(one, other, _):
            result = fcl.CollisionResult()
            if fcl.collide(one, other, DEEP, result):
                depth = max(contact.penetration_depth for contact in result.contacts)
                pair = [self.panel_of[id(shape)] for shape in (result.contacts[0].o1, result.contacts[0].o2)]
                found[max(pair), min(pair)] = depth
            return False

        manager.collide(None, look)
        return found


class Tally:
    """What came of the pairs of one plan, or of several."""

    def __init__(self):
        self.plans = self.poses = self.pairs = self.ours = self.theirs = self.touches = 0
        self.only_ours, self.only_theirs = [], []
        self.deep_in_free = 0
        self.deepest_in_free = 0.0

    def compare(self, gap, depth, touching, free):
        """One pair: our gap, where we have one, and FCL's depth, where it says that they meet."""
        ours = gap is not None and gap < -touching
        deep = depth is not None and depth > TOUCH
        self.ours += ours
        self.theirs += deep
        self.touches += depth is not None and not deep
        if ours and (depth is None or depth <= TOUCH < -gap):
            self.only_ours.append(-gap)
        if depth is not None and not ours:
            # From what is between them for us to how deep they are for FCL.
            self.only_theirs.append(depth + max(gap, 0.0) if gap is not None else math.inf)
        if free and depth is not None:
            self.deep_in_free += deep
            self.deepest_in_free = max(self.deepest_in_free, depth)

    def add(self, other):
        for name in ("plans", "poses", "pairs", "ours", "theirs", "touches", "deep_in_free"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.only_ours += other.only_ours
        self.only_theirs += other.only_theirs
        self.deepest_in_free = max(self.deepest_in_free, other.deepest_in_free)

    def faults(self):
        return sum(depth > TOUCH for depth in self.only_ours + self.only_theirs) + self.deep_in_free

    def row(self, name, free):
        differ = self.only_ours + self.only_theirs
        differ = f"{len(differ)} ({sum(depth > TOUCH for depth in differ)})"
        deepest = [f"{max(depths):.1e}" if depths else "none" for depths in (self.only_ours, self.only_theirs)]
        said = f"{self.deep_in_free} ({self.deepest_in_free:.1e})" if free else ""
        return (
            f"| {name} | {self.plans} | {self.poses} | {self.pairs} | {self.ours} | {self.theirs} | {self.touches} "
            f"| {differ} | {deepest[0]} | {deepest[1]} | {said} |"
        )


HEAD = (
    "| plan: certified | plans | poses | pairs | ours collide | FCL's deeper than a touch | FCL's touching | "
    "verdicts differ (by more than a touch) | deepest of ours only | of FCL's only | FCL's collisions in free motion (deepest) |\n|---|---|---|---|---|---|---|---|---|---|---|"
)


def compared(folder, head):
    """All pairs of a plan's poses, looked at by FCL."""
    plates = Plates(folder, head)
    pairs = np.fromfile(folder / f"{head['name']}.pairs", dtype=PAIRS)
    ends = np.searchsorted(pairs["pose"], np.arange(head["poses"] + 1))
    touching, free = head["touching"], head["free"]
    tally = Tally()
    tally.plans, tally.poses, tally.pairs = 1, head["poses"], len(pairs)
    for pose in range(head["one_by_one"]):
        plates.place(pose)
        for _, a, b, gap in pairs[ends[pose] : ends[pose + 1]].tolist():
            tally.compare(gap, depth_of(plates.objects[a], plates.objects[b]), touching, free)
    if head["poses"] > head["one_by_one"]:
        manager = fcl.DynamicAABBTreeCollisionManager()
        manager.registerObjects(plates.objects)
        manager.setup()
        for pose in range(head["one_by_one"], head["poses"]):
            plates.place(pose)
            met = plates.all_meetings(manager)
            gaps = {(a, b): gap for _, a, b, gap in pairs[ends[pose] : ends[pose + 1]].tolist()}
            for pair in gaps.keys() | met.keys():
                tally.compare(gaps.get(pair), met.get(pair), touching, free)
    return tally


def timed(folder, head):
    """Pairs a second: FCL's as it is called, what such a call allows at the most, and ours; pairs from all over the motion."""
    plates = Plates(folder, head)
    pairs = np.fromfile(folder / f"{head['name']}.pairs", dtype=PAIRS)
    ends = np.searchsorted(pairs["pose"], np.arange(head["poses"] + 1))
    step = max(1, head["pairs"] // TIMED)
    # Two spheres far apart: next to no work but the call.
    far, near = (fcl.CollisionObject(fcl.Sphere(0.1), fcl.Transform(np.array([x, 0.0, 0.0]))) for x in (0.0, 9.0))

    def took(couples):
        results = [fcl.CollisionResult() for _ in couples]
        begin = time.process_time()
        for (one, other), result in zip(couples, results):
            fcl.collide(one, other, PLAIN, result)
        return time.process_time() - begin

    count, looked, called = 0, 0.0, 0.0
    for pose in range(head["one_by_one"]):
        plates.place(pose)
        first = ends[pose] + -ends[pose] % step
        couples = [(plates.objects[a], plates.objects[b]) for _, a, b, _ in pairs[first : ends[pose + 1] : step].tolist()]
        if couples:
            count += len(couples)
            looked += took(couples)
            called += took([(far, near)] * len(couples))
    return f"| {head['name']} | {count} | {count / looked:.0f} | {count / called:.0f} | {head['pairs'] / head['seconds']:.0f} |"


def main():
    folder = Path(sys.argv[1])
    heads = [json.loads(file.read_text()) for file in sorted(folder.glob("*.json"))]
    print(f"\nBeside FCL {fcl.__version__}; a touch is an overlap of at most {TOUCH} panel lengths:\n")
    print(HEAD)
    small, faults = {}, Counter()
    for head in heads:
        tally = compared(folder, head)
        faults[head["name"]] = tally.faults()
        said = "free" if head["free"] else "collides"
        if head["name"].startswith(GROUP):
            small.setdefault(said, Tally()).add(tally)
        else:
            print(tally.row(f"{head['name']}: {said}", head["free"]), flush=True)
    for said, tally in small.items():
        print(tally.row(f"random solids: {said}", said == "free"), flush=True)
    print("\nPairs a second, one core:\n")
    print("| plan | pairs timed | FCL's verdict, called from Python | such calls for two far spheres | ours, with the depth |\n|---|---|---|---|---|")
    for head in islice((head for head in heads if not head["name"].startswith(GROUP)), 0, None, 4):
        print(timed(folder, head), flush=True)
    wrong = [f"{name} ({count})" for name, count in faults.items() if count]
    if wrong:
        sys.exit(f"FCL and we differ by more than a touch: {', '.join(wrong)}")


main()
