"""Finds a floor by mDNS on this machine, with the library zeroconf, and reads it by OSCQuery.

Usage: discover.py PROGRAM. Exit status 0: success; 1: a failure, described on standard error; 77: the library or a
network namespace is missing, nothing was tried. The script starts itself anew in a network namespace of its own, so
that nothing leaves this machine.
"""

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

try:
    from zeroconf import ServiceBrowser, ServiceStateChange, Zeroconf
except ImportError as missing:
    print(f"not run: {missing}; pip install zeroconf", file=sys.stderr)
    sys.exit(77)

SERVICE = "_oscjson._tcp.local."
ALONE = "UNDERFOOT_ALONE"

if ALONE not in os.environ:
    for unshare in (["unshare", "--net"], ["unshare", "--user", "--map-root-user", "--net"]):
        if subprocess.run(unshare + ["ip", "link", "set", "lo", "up"], capture_output=True).returncode == 0:
            inner = 'ip link set lo multicast on up && ip route add 224.0.0.0/4 dev lo && exec "$@"'
            os.environ[ALONE] = "1"
            os.execvp(unshare[0], unshare + ["sh", "-c", inner, "sh", sys.executable, *sys.argv])
    print("not run: no network namespace can be made here", file=sys.stderr)
    sys.exit(77)


def wait_until(what, happened, seconds=30.0):
    """Waits for an event that must happen."""
    end = time.monotonic() + seconds
    while not happened():
        assert time.monotonic() < end, f"never happened: {what}"
        time.sleep(0.02)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def get(address, path):
    """The status and the JSON at this path."""
    try:
        with urllib.request.urlopen(f"http://{address}{path}", timeout=10) as answer:
            text = answer.read()
            return answer.status, json.loads(text) if text else None
    except urllib.error.HTTPError as refused:
        return refused.code, None


there = {}


def changed(zeroconf, service_type, name, state_change):
    if state_change is ServiceStateChange.Removed:
        there.pop(name, None)
    else:
        there[name] = zeroconf.get_service_info(service_type, name, 3000)


def main(program):
    port = free_port()
    with tempfile.TemporaryDirectory() as folder, Zeroconf(interfaces=["127.0.0.1"]) as zeroconf:
        ServiceBrowser(zeroconf, SERVICE, handlers=[changed])
        options = ["run", "map", "--listen", "127.0.0.1:0", f"--discover=127.0.0.1:{port}", "--no-osc", "--wav", "o.wav"]
        floor = subprocess.Popen([program, *options], cwd=folder, stderr=subprocess.DEVNULL)
        try:
            wait_until("the floor is found", lambda: any(there.values()))
            ((name, service),) = there.items()
            assert name.endswith("." + SERVICE) and name.startswith("underfoot"), name
            assert service.port == port, service
            assert service.parsed_addresses() == ["127.0.0.1"], service.parsed_addresses()
            address = f"127.0.0.1:{service.port}"
            status, info = get(address, "/?HOST_INFO")
            assert status == 200 and name.startswith(info["NAME"].split(".")[0]), info
            status, value = get(address, "/underfoot/widget/zoom/value?VALUE")
            assert (status, list(value)) == (200, ["VALUE"]), value
            assert get(address, "/underfoot/widget/zoom/set?VALUE")[0] == 204
            assert get(address, "/nowhere")[0] == 404
            floor.send_signal(signal.SIGTERM)
            assert floor.wait(timeout=30) == 0
            wait_until("the floor is gone", lambda: not there)
        finally:
            floor.kill()
            floor.wait()


main(sys.argv[1])
