"""A display of its own: Xvfb, with input by xdotool and pictures by ImageMagick."""
import os
import random
import shutil
import subprocess

PROGRAMS = ("Xvfb", "xdotool", "import")
# Maximum number of servers that are started until one can be reached.
STARTS = 5


class Display:
    """A screen of `size` pixels without any window; programs with the environment `env` show themselves on it."""

    def __init__(self, size, env=None):
        for _ in range(STARTS):
            number = self.start(size)
            probe = ["xdotool", "getdisplaygeometry"]
            if subprocess.run(probe, env=dict(os.environ, DISPLAY=f":{number}"), capture_output=True).returncode == 0:
                break
            # Another server has this number.
            end(self.server)
        self.env = dict(os.environ, DISPLAY=f":{number}", LIBGL_ALWAYS_SOFTWARE="1", **(env or {}))
        self.env.pop("WAYLAND_DISPLAY", None)

    def start(self, size):
        """Starts the server; returns the number of its display.

        The first free number may be that of a server which is ending, and which removes the socket of its number.
        """
        number = random.randrange(100, 30_000)
        read, write = os.pipe()
        # Without -r, a key that a busy machine releases late repeats itself. Without -noreset, the server begins anew once
        # its last client has left, and refuses the next one meanwhile.
        options = ["-r", "-noreset", "-nolisten", "tcp", "-screen", "0", f"{size[0]}x{size[1]}x24"]
        self.server = subprocess.Popen(["Xvfb", f":{number}", "-displayfd", str(write), *options],
                                       pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        # The reading end stays open: the server may still write the end of its line.
        return os.read(read, 16).decode().strip() or number

    def x(self, *arguments, timeout=300):
        """One command of xdotool; returns what it prints."""
        done = subprocess.run(["xdotool", *map(str, arguments)], env=self.env, check=True, capture_output=True, timeout=timeout)
        return done.stdout.decode()

    def windows(self, *criterion):
        """The numbers of the windows shown that xdotool finds by this criterion, such as "--name" and a pattern.

        None while there is none, nor if one goes during the search, which then fails.
        """
        search = ["xdotool", "search", "--onlyvisible", *criterion]
        return subprocess.run(search, env=self.env, capture_output=True, text=True).stdout.split()

    def pixels(self):
        """The screen row by row, three bytes for each pixel: red, green, blue."""
        command = ["import", "-window", "root", "-depth", "8", "rgb:-"]
        return subprocess.run(command, env=self.env, check=True, capture_output=True).stdout

    def save(self, path):
        subprocess.run(["import", "-window", "root", path], env=self.env, check=True)

    def close(self):
        end(self.server)


def end(process, seconds=5):
    """Ends a process, by force if it takes longer than this."""
    process.terminate()
    try:
        process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def missing(*programs):
    """Those of these programs that are not installed."""
    return [program for program in programs if shutil.which(program) is None]
