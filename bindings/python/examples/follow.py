"""Prints what the feet on a simulated floor do: python follow.py map.ron, or with a scenario after the layout."""
import sys, underfoot

with underfoot.simulated(*sys.argv[1:3]) as floor:
    for event in floor:
        match event:
            case underfoot.ChangedEvent(id, value):
                print(id, value)
            case underfoot.ControlEvent(id, name):
                print(id, name)
            case underfoot.LinkEvent(state):
                print("boards:", state)  # "lost" has cancelled what was held; "live" comes by itself
