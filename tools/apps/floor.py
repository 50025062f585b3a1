"""`underfoot run` with a layout, and a simulated floor beside it whose people play a scenario in real time."""
import json
import os
import queue
import socket
import subprocess
import threading
import time

# A floor of average parts; its calibration comes from the same number.
SEED = "3"


class Floor:
    """Serves `layout` with its target `target` on the display of `env`; `play` begins the scenario."""

    def __init__(self, program, layout, scenario, target, env, folder):
        self.program, self.layout, self.scenario, self.env = program, layout, scenario, env
        measured = os.path.join(folder, "floor.ron")
        subprocess.run([program, "simulate", "--seed", SEED, "--write-floor", measured, "--seconds", "0.1"],
                       check=True, env=env, capture_output=True)
        self.address = "127.0.0.1:" + str(free_port())
        self.log = open(os.path.join(folder, "messages"), "w")
        self.server = subprocess.Popen(
            [program, "run", layout, "--floor", measured, "--listen", self.address, "--json", "--no-osc", "--sound", "off",
             "--target", f"{target}={env['DISPLAY']}"], env=env, stdout=subprocess.PIPE, stderr=self.log, text=True)
        self.events = queue.Queue()
        threading.Thread(target=self.read, daemon=True).start()
        time.sleep(1)
        self.people = None

    def read(self):
        for line in self.server.stdout:
            self.events.put(json.loads(line))

    def play(self):
        self.people = subprocess.Popen(
            [self.program, "simulate", self.layout, "--seed", SEED, "--scenario", self.scenario, "--send", self.address], env=self.env,
            stdout=subprocess.DEVNULL, stderr=self.log)

    def wait_for(self, event, control, seconds=60):
        """Waits for this event of the control."""
        end = time.monotonic() + seconds
        while True:
            try:
                line = self.events.get(timeout=max(0.01, end - time.monotonic()))
            except queue.Empty:
                raise SystemExit(f"no foot has {event} \"{control}\" within {seconds} s")
            if line.get("event") == event and line.get("id") == control:
                return

    def close(self):
        for process in (self.people, self.server):
            if process is not None:
                process.terminate()
                process.wait()
        self.log.close()


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]
