"""The public names are typed: a user's script passes mypy in strict mode, and a wrong one does not."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import numpy as np

import singimpact as si

duffing = si.ImpactOscillator("x + 0.1*xdot + x**3", "cos(w*t)", "0.3", restitution=0.6, parameters={"w": 1.7})
osc = si.linear(omega=2, clearance="0.3", restitution="0.5")
step = osc.impact_map(np.array([1.2]), 0.01)
print(step.tau, step.v, step.status, step.flight_time, step.condition, osc.derivative(1.2, 0.1).matrix)
limit = osc.chatter_limit("1.2", "0.01")
print(limit.tau, limit.error, limit.impacts, si.Status(limit.status).sentence)
for kind, start, end in osc.orbit("1.2", "0.3", impacts=60).phases:
    print(kind.upper(), end - start)
for point in si.tangency_points(osc):
    print(point.tau, point.kind)
for swan in si.swan_points("x", "cos(2*t)", over="clearance"):
    print(swan.clearance, swan.kind, swan.oscillator("0.5").clearance)
print(si.threshold(osc, "1.5").v, si.universal(-1, "1/2").to_toml(), duffing.replace(w=2))
print(si.theory.gamma(order=3, at="tangency")[2], si.theory.v_c(order=3, at="swan"))
print(si.fixed_points.tangency("1/2", digits=50).lambda_.value)
for verdict in si.verify("e:meq"):
    print(verdict.id, verdict.kind, verdict.corrected)
scene = si.Scene(osc, ("gamma",), (0, 3), v=(0, 1), pixels=200)
print(scene.report()["flights"], len(si.errata()), si.claims["e:meq"].printed.latex, si.figure(12))
print(si.basins(osc, size=4).classes, si.bifurcation(osc, "clearance", (0.2, 0.3), 2).events.shape)
print(si.classify(osc).points[0].name, si.transitions(osc, between=("0.9", "1.1")).complete)
print(si.grown_gamma(osc)[0].points, si.explore(osc, points=3).film.flights, si.sweep(abs, [1.0]).tolist())
print(si.ImpactSurface(osc, (0, 3), (-3, 3)).horizon)
found = osc.orbit(x=1.0, xdot=0, t=0)
print(found.sample([0.1]).x, found.section("pi/4").xdot, found.end, osc.launch(1, [0.0, 1.0], 0).status)
print(si.lyapunov(osc, 1.2, 0.1, impacts=10).exponents, si.lyapunov(osc, 1.2, 0.1).superstable)
print(si.shaken_wall("0", "-9.81", "sin(7*t)/5", "1/2").back(0.1).xdot)
print(si.bifurcation(osc, "damping", (0.2, 0.3), 2, direction="both").direction)
moved: si.ImpactOscillator = osc.replace(clearance="0.4")
print(moved.release(1.2) + 1.0, moved.impact_map(1.2, 0.1).v, si.theory.grazing_map(2, model=osc, at=0).xdot[1])
pair = osc.replace(upper="0.9")
print(pair.first_hit(1.2, 0.1, wall="upper", digits=20).wall, pair.impact_map(1.2, [0.1], wall=["u"], threads=1).v)
print(osc.periodic(1, 1)[0].multipliers, osc.flight(1.2, 0.1, 0.05).x, osc.inverse_map(1.2, 0.1).tau)
"""


def checked(script, tmp_path, clone):
    path = tmp_path / "user.py"
    path.write_text(script)
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--follow-imports",
        "silent",
        "--cache-dir",
        str(tmp_path / "cache"),
        str(path),
    ]
    return subprocess.run(
        command, cwd=tmp_path, env=os.environ | {"MYPYPATH": str(clone)}, capture_output=True, text=True
    )


@pytest.mark.slow
def test_a_users_script_is_typed(tmp_path, clone):
    done = checked(SCRIPT, tmp_path, clone)
    assert done.returncode == 0, done.stdout


@pytest.mark.slow
def test_a_wrong_script_is_told(tmp_path, clone):
    wrong = 'osc.orbit("1.2", "0.3", impacts="60")\nsi.universal(1)\nosc.first_hit(1, 1, digts=3)\n'
    done = checked(SCRIPT + wrong, tmp_path, clone)
    assert 'Unexpected keyword argument "digts"' in done.stdout
    assert 'incompatible type "str"' in done.stdout
    assert 'Missing positional argument "restitution"' in done.stdout


def test_the_package_says_that_it_is_typed(clone):
    assert (clone / "singimpact" / "py.typed").exists()
