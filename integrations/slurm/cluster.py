"""A Slurm cluster for tests on this one machine: a controller and four nodes as real daemons, on the loopback interface only."""

import getpass
import os
import secrets
import socket
import subprocess
import sys
import time
from pathlib import Path

from processes import Family, kill

NODES = 4
CONFIGURATION = """\
ClusterName=drypoint
SlurmctldHost=localhost(127.0.0.1)
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
# A part that is drawn again waits for its old credential to end, by default for two minutes.
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/controller.pid
SlurmctldLogFile={folder}/controller.log
StateSaveLocation={folder}/state
SlurmdPidFile={folder}/%n.pid
SlurmdLogFile={folder}/%n.log
SlurmdSpoolDir={folder}/%n
# Control groups would need the machine's own.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
# So soon the controller looks for jobs whose processes are gone.
SlurmdTimeout=10
SlurmctldTimeout=10
KillWait=2
MpiDefault=none
SchedulerParameters=sched_interval=2,bf_interval=2,batch_sched_delay=0
NodeName=worker[1-{nodes}] NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[1]}-{ports[2]} CPUs=1 RealMemory=1000
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def free_ports(count: int) -> int:
    """The first of so many ports in a row that nothing listens to."""
    while True:
        first = 20_000 + secrets.randbelow(10_000)
        probes = [socket.socket() for _ in range(count)]
        try:
            for offset, probe in enumerate(probes):
                probe.bind(("127.0.0.1", first + offset))
            return first
        except OSError:
            continue
        finally:
            for probe in probes:
                probe.close()


class Cluster:
    def __init__(self, folder: Path, family: Family) -> None:
        self.family = family
        folder.mkdir()
        (folder / "state").mkdir()
        key = folder / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o400)
        port = free_ports(NODES + 1)
        ports = (port, f"[{port + 1}", f"{port + NODES}]")
        text = CONFIGURATION.format(folder=folder, user=getpass.getuser(), nodes=NODES, ports=ports)
        (folder / "slurm.conf").write_text(text)
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
        os.environ["PATH"] += ":/usr/sbin"
        munge = ["--key-file", key, "--socket", folder / "munge.socket", "--pid-file", folder / "munge.pid"]
        munge += ["--log-file", folder / "munge.log", "--seed-file", folder / "munge.seed", "--force"]
        subprocess.run(["munged", *munge], check=True)
        self.start_controller()
        for node in range(1, NODES + 1):
            (folder / f"worker{node}").mkdir()
            subprocess.run(["slurmd", "-N", f"worker{node}"], check=True)
        for _ in range(120):
            if ask("sinfo", "--noheader", "--states=idle", "--format=%D").strip() == str(NODES):
                return
            time.sleep(0.5)
        sys.exit(f"Slurm's nodes do not come up: {ask('sinfo', '--long')}")

    def start_controller(self) -> None:
        subprocess.run(["slurmctld"], check=True)

    def kill_controller(self) -> None:
        """And starts it again, as whatever watches over it would: it finds its state in its files."""
        for process in self.family.processes():
            if Path(process.command[0]).name == "slurmctld":
                kill(process.pid)
        time.sleep(2)
        self.start_controller()


def ask(*command: str) -> str:
    """What a command of Slurm says; it is asked again while the controller is away."""
    for _ in range(60):
        done = subprocess.run(command, capture_output=True, encoding="utf-8")
        if done.returncode == 0:
            return done.stdout
        time.sleep(1)
    sys.exit(f"{' '.join(command)}: {done.stderr}")
