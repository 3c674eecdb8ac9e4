"""OR-Tools CP-SAT on the scheduling problems that the example `schedule_times` writes.

    schedules.py FOLDER

Prints a Markdown table. `cargo xtask bench deployment --peers` runs it.
"""

import json
import math
import sys
import time
from pathlib import Path

from ortools.sat.python import cp_model

TIMEOUT_S = 8


def shortest(problem):
    """The makespan that CP-SAT finds, the bound that it proves, and how it names the result."""
    limit = problem["limit"]
    # In units that divide all times, which spares the solver much.
    unit = math.gcd(*(duration for duration, _, _ in problem["tasks"]))
    tasks = [(duration // unit, current, hold) for duration, current, hold in problem["tasks"]]
    horizon = sum(duration for duration, _, _ in tasks)
    model = cp_model.CpModel()
    end_of_all = model.new_int_var(0, horizon, "end")
    loads, demands, ends, starts = [], [], [], []
    for duration, current, hold in tasks:
        start = model.new_int_var(0, horizon, "")
        starts.append(start)
        ends.append(start + duration)
        loads.append(model.new_fixed_size_interval_var(start, duration, ""))
        demands.append(current)
        model.add(end_of_all >= start + duration)
        if hold:
            held = model.new_int_var(0, horizon, "")
            loads.append(model.new_interval_var(start + duration, held, end_of_all, ""))
            demands.append(hold)
    for task, before in enumerate(problem["waits_for"]):
        for other in before:
            model.add(starts[task] >= ends[other])
    model.add_cumulative(loads, demands, limit)
    model.minimize(end_of_all)
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = TIMEOUT_S
    solver.parameters.num_workers = 2
    solver.parameters.random_seed = 1
    status = solver.solve(model)
    found = round(solver.objective_value) * unit if status in (cp_model.OPTIMAL, cp_model.FEASIBLE) else None
    return found, round(solver.best_objective_bound) * unit, solver.status_name(status).lower()


def main():
    print(f"\nBeside OR-Tools CP-SAT, at most {TIMEOUT_S} s each, times in ms:\n")
    print("| problem | ours | our bound | CP-SAT | its bound | it says | took, s |\n|---|---|---|---|---|---|---|")
    for file in sorted(Path(sys.argv[1]).glob("*.json")):
        problem = json.loads(file.read_text())
        begin = time.monotonic()
        found, bound, status = shortest(problem)
        took = time.monotonic() - begin
        ours = f"| {problem['name']} | {problem['makespan']} | {problem['lower_bound']} "
        print(f"{ours}| {found} | {bound} | {status} | {took:.1f} |", flush=True)


main()
