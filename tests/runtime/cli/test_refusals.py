"""Refusals of the commands: status 2, nothing printed, one line on standard error."""

import shlex

import pytest
from command_runs import refused

FREE = "--set model.formulation=free_free --set model.modes=1"
THIN = "smith_1972_101104_thirtysecond_inch"
# Command line | words of the complaint.
REFUSED = """
 | --help
chrt | --help
show | --help
show smith_1972_5152_sixteenth_inch --nope | --help
show smith_1972_5152_sixteenth_inch --set links.crank | found
show smith_1972_5152_sixteenth_inch --set =3 | found
show smith_1972_5152_sixteenth_inch --set links.crnk=3 | found
show smith_1972_5152_sixteenth_inch --set crank=3 | found
show nothing.toml |
kinematics mathieu |
kinematics smith_1972_2122 --angles 0:360 |
kinematics smith_1972_2122 --angles 0:360:13kg |
kinematics smith_1972_2122 --angles 360:0:13 |
critical-speeds aannaque_1996_table_4_1 --range 70:20 | LOW:HIGH, rising
critical-speeds aannaque_1996_portal_frame --range 3:4 | no crank
campbell aannaque_1996_portal_frame --range 3:4 | no crank
steady-state aannaque_1996_portal_frame --speed '3 rad/s' | no crank
stress aannaque_1996_portal_frame --set frame.axial=elastic --speed '3 rad/s' | no crank
running-speed aannaque_1996_portal_frame --range 3:4 --limit '250 MPa' | no crank
run-through aannaque_1996_portal_frame --from '1 rad/s' --to '2 rad/s' --time '1 s' | no crank
simulate smith_1972_5152_sixteenth_inch --speed '0 rpm' |
simulate smith_1972_5152_sixteenth_inch --revolutions -1 |
simulate mathieu | --initial Q,QD
simulate smith_1972_2122 --speed '3 rpm' |
stability smith_1972_5152_sixteenth_inch --speed=-100:100:5rpm |
chart smith_1972_2122 |
show smith_1972_5152_sixteenth_inch --modules no_such_folder |
reproduce --out /dev/null/gallery |
chart smith_1972_5152_sixteenth_inch --x sped=1:2:3 | did you mean speed?
chart smith_1972_5152_sixteenth_inch --x speed | START:STOP:COUNT
chart smith_1972_5152_sixteenth_inch --x speed=1:2 | START:STOP:COUNT
chart smith_1972_5152_sixteenth_inch --y speed=100:900:20rpm | another parameter
chart smith_1972_5152_sixteenth_inch --y follower_inertia=1:2:3m | [length]
boundaries mathieu --regions 1-3 | 1,3,5 or 1:6
boundaries mathieu --speed 1:2 | a scene of a linkage
boundaries smith_1972_101104_sixteenth_inch --mu 0.3 | a scene of Hill's equation
boundaries smith_1972_101104_sixteenth_inch --set model.modes=2 --order 2 | one undamped mode
perturb smith_1972_101104_sixteenth_inch --set model.modes=2 | one mode
perturb mathieu --latex --plot x.png | without --latex
perturb mathieu --order 9 | expected 1 to 8
clearance smith_1972_10_8_10_10 | --clearance
clearance smith_1972_10_8_10_10 --clearance '0.1 s' | --clearance
clearance smith_1972_10_8_10_10 --at '55=0.1 in' | --at
clearance smith_1972_10_8_10_10 --at 34 | --at
clearance smith_1972_10_8_10_10 --at '34=0.1 in' --clearance '0.1 in' | --at
forces smith_1972_12_6_12_12 --speed 0 --fluctuation 0.02 | --fluctuation
kinematics slider_crank_example --speed fast | --speed
kinematics slider_crank_example --acceleration '9.81 m/s**2' | --acceleration
kinematics slider_crank_example --animate moving.mp4 | the ending '.gif'
kinematics slider_crank_example --animate nowhere/at/all.gif | a writable folder
classify --lengths 12,6,12 | 4 lengths
classify | --lengths
curve smith_1972_12_6_12_12 --point 0.5 | --point
harmonics mathieu --of theta4 | a linkage
balance smith_1972_10_8_10_10 --speed 10 | no mass
balance smith_1972_12_6_12_12 --speed 0 | --speed
balance smith_1972_12_6_12_12 --case b --weights torque=1 | --weights
balance smith_1972_12_6_12_12 --case b --mass '1 kg' | --mass
balance smith_1972_12_6_12_12 --trade-off torque,f23 --measure rms | --measure
balance smith_1972_12_6_12_12 --points 5 | --points
balance smith_1972_12_6_12_12 --limits torque=0.01 | torque at least 1;
harmonics smith_1972_12_6_12_12 --of theta4 --stop every | --stop
harmonics smith_1972_12_6_12_12 --of theta4 --speed 10 | --speed
forces smith_1972_12_6_12_12 --joint 34 | --joint
classify smith_1972_12_6_12_12 --base-plane | --base-plane
classify slider_crank_example --input follower | --input
stability beale_1992_flexible_rod {free} --speed 90:110:3 | one speed
simulate beale_1992_flexible_rod {free} --method rk4 | collocation
simulate beale_1992_flexible_rod {free} --initial 1,0 | --initial
chart beale_1992_flexible_rod {free} | free_free_linear
steady-state beale_1992_flexible_rod --at 1.5 | from 0 to 1
steady-state beale_1992_flexible_rod --speed=-3:4:5 | positive speeds
run-up smith_1972_12_6_12_12 | --stall-torque
run-up smith_1972_12_6_12_12 --stall-torque '5 N*m' | --no-load-speed
run-up slider_crank_example --torque '5 N*m' --no-load-speed 90 | --torque
run-up slider_crank_example --torque '5 kg' | --torque
run-up slider_crank_example --duration 'nan s' | duration
balance smith_1972_12_6_12_12 --speed 10 --weights torque=x |
balance smith_1972_12_6_12_12 --speed 10 --offset '-1 in' |
balance smith_1972_12_6_12_12 --speed 10 --offset '3 kg' |
balance smith_1972_12_6_12_12 --speed 10 --trade-off torque |
balance smith_1972_12_6_12_12 --speed 10 --trade-off shaking_force,torque --case b |
response slider_crank_example | a nonlinear formulation; choose a scene with a flexible coupler
response aannaque_1996_table_4_1 | choose a scene with a flexible coupler
response mathieu | choose a scene with a flexible coupler
response {rig} --speed 360:350rpm | --speed: found '360:350rpm'; expected LOW:HIGH
response {rig} --speed '350 rpm' | expected LOW:HIGH
response {rig} --turns 0 | turns: found 0; expected a whole number from 1 to 64
response {rig} --kicks 1e-3 | --kicks: found an option that does nothing here
response {rig} --sweep '2 rpm' | --sweep: found '2 rpm', of dimension
response {rig} --sweep '-2 rpm/s' | --sweep: found '-2 rpm/s'; expected a positive
response {rig} --sweep '2 rpm/s' --search | --search: found an option that does nothing here
response {rig} --sweep '2 rpm/s' --in bow=0:1 | --in: found an option that does nothing
response {rig} --speed '350 rpm' --in foo=1:2 | --in: found 'foo'; expected one of
response {rig} --speed '350 rpm' --in bow=1 | --in bow: found '1'; expected LOW:HIGH
response {rig} --speed '350 rpm' --in follower.inertia=1 | --in follower.inertia: found '1'
response {rig} --speed 350:360rpm --in bow=0:1 | give one value, no range
"""


@pytest.mark.parametrize("line", REFUSED.strip("\n").splitlines())
def test_refusal_is_one_line(capsys, line):
    for short, words in {"{free}": FREE, "{rig}": THIN}.items():
        line = line.replace(short, words)
    command, _, words = line.rpartition("|")
    assert words.strip() in refused(capsys, *shlex.split(command))
