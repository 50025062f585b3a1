"""Prints the events of the control `home` on a simulated floor: press.py LAYOUT SCENARIO."""

import sys

import underfoot

with underfoot.simulated(*sys.argv[1:3]) as floor:
    for event in floor:
        match event:
            case underfoot.ControlEvent("home", name):
                print("home", name)
