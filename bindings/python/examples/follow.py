"""Prints what feet do: python follow.py 127.0.0.1:9000 map.ron, and elsewhere `underfoot simulate`."""
import sys, underfoot

with underfoot.listen(*sys.argv[1:3]) as floor:
    for event in floor:
        if event.kind == "control":
            print(event.id, event.name, event.value)
        if event.text == "lost":
            break
