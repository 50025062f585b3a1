#!/bin/bash
# A systemd of its own, as process 1 of new namespaces: systemd_box.sh FOLDER PROGRAM UNIT
# Its files are those of this machine, read-only, except for private /etc, /run, /tmp and /var; its network, processes and
# control groups are private too. It has only UNIT and the dependencies of UNIT, and ends with this script.
# FOLDER gets the process number of systemd (`init`) and, inside, the output of the unit (`/run/said`).
set -eu
folder=$1 program=$2 unit=$3
groups=$(awk '$3 == "cgroup2" { print $2; exit }' /proc/mounts)
group=$groups/underfoot-test-$$
mkdir "$group"
clean() { find "$group" -depth -type d -exec rmdir {} + 2>/dev/null || true; }
trap clean EXIT
(echo "$BASHPID" >"$group/cgroup.procs"
exec unshare --mount --pid --fork --kill-child --ipc --uts --net --cgroup bash -eu -s "$folder" "$program" "$unit" <<'BOX'
folder=$1 program=$2 unit=$3 root=$1/root
mount --make-rprivate /
mkdir "$root"
mount -t tmpfs -o mode=755 tmpfs "$root"
for name in usr bin sbin lib lib32 lib64; do
    if [ -L "/$name" ]; then
        cp -a "/$name" "$root/$name"
    elif [ -d "/$name" ]; then
        mkdir "$root/$name"
        mount --bind "/$name" "$root/$name"
        mount -o remount,bind,ro "$root/$name"
    fi
done
mkdir -p "$root"/{dev,etc/systemd/system,home,proc,root,run,sys,tmp,opt,var/lib,var/tmp}
for name in group ld.so.cache nsswitch.conf passwd; do cp "/etc/$name" "$root/etc/" 2>/dev/null || true; done
mount -t proc proc "$root/proc"
mount --bind "$root/proc/sys" "$root/proc/sys"
mount -o remount,bind,ro "$root/proc/sys"
mount -t sysfs -o ro sysfs "$root/sys"
mount -t cgroup2 cgroup2 "$root/sys/fs/cgroup"
for name in null zero full random urandom; do
    touch "$root/dev/$name"
    mount --bind "/dev/$name" "$root/dev/$name"
done
mkdir "$root/dev/shm" "$root/dev/pts" "$root/dev/mqueue"
touch "$root/opt/program"
mount --bind "$program" "$root/opt/program"
cp -r "$folder/etc/." "$root/etc/"
units=$root/etc/systemd/system
printf '[Service]\nStandardOutput=append:/run/said\nStandardError=inherit\n' >"$folder/output"
mkdir "$units/$unit.d"
mv "$folder/output" "$units/$unit.d/output.conf"
for name in sysinit basic shutdown network multi-user; do
    printf '[Unit]\nDefaultDependencies=no\n' >"$units/$name.target"
done
printf '[Unit]\nDefaultDependencies=no\nWants=%s\n' "$unit" >"$units/box.target"
mkdir "$root/old"
cd "$root"
pivot_root . old
umount -l /old
init=/usr/lib/systemd/systemd
[ -x $init ] || init=/lib/systemd/systemd
# Without a unit path of its own it would start the units of this machine.
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin container=test SYSTEMD_UNIT_PATH=/etc/systemd/system \
    $init --system --unit=box.target --log-target=console --show-status=no </dev/null
BOX
) &
# The child of `unshare` is systemd.
waiter=$!
while ! child=$(pgrep -P "$waiter"); do
    kill -0 "$waiter"
    sleep 0.05
done
echo "$child" >"$folder/init"
# The test closes this input when it ends in any way.
cat >/dev/null || true
kill -KILL "$child" 2>/dev/null || true
wait "$waiter" || true
