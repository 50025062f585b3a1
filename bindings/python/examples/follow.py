"""Prints what feet do: python follow.py 127.0.0.1:9000 map.ron, and elsewhere `underfoot simulate`."""
import sys, underfoot

with underfoot.listen(*sys.argv[1:3]) as floor:
    for event in floor:
        match event:
            case underfoot.ChangedEvent(id, value):
                print(id, value)
            case underfoot.ControlEvent(id, name):
                print(id, name)
            case underfoot.LinkEvent(state):
                print("boards:", state)  # "lost" has cancelled what was held; "live" comes by itself
