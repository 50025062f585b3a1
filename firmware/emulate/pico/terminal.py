#!/usr/bin/env python3
"""terminal.py COMMAND...: runs a command with the master of a pseudo terminal as file descriptor 3.

The path of the terminal is the first line printed.
"""

import os
import sys
import tty

MASTER = 3


def main():
    master, other = os.openpty()
    tty.setraw(other)
    path = os.ttyname(other)
    # Only a terminal that has been open says later that it is closed.
    os.close(other)
    if master != MASTER:
        os.dup2(master, MASTER)
        os.close(master)
    os.set_inheritable(MASTER, True)
    os.set_blocking(MASTER, False)
    print(path, flush=True)
    os.execvp(sys.argv[1], sys.argv[1:])


if __name__ == "__main__":
    main()
