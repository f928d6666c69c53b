#!/bin/bash
# Runs in namespaces of its own: room.sh ROOT WORK COMMAND…
# /usr and /etc have what ROOT holds as well, and what is written there is gone afterwards; WORK is /mnt/work. Nothing of this is
# seen outside: not the mounts, not the shared memory, not the processes, and no port is open.
set -e
exec 3< "$1" 4< "$2" # they may lie below what is mounted over
mount -t tmpfs tmpfs /mnt
mkdir /mnt/root /mnt/work /mnt/tmp /mnt/home /mnt/usr /mnt/usr.work /mnt/etc /mnt/etc.work
mount --bind /proc/$$/fd/3 /mnt/root
mount --bind /proc/$$/fd/4 /mnt/work
exec 3<&- 4<&-
for part in usr etc; do
  mount -t overlay overlay -o "lowerdir=/mnt/root/$part:/$part,upperdir=/mnt/$part,workdir=/mnt/$part.work" "/$part"
done
chmod 1777 /mnt/tmp
mount --bind /mnt/tmp /tmp
shift 2
cd /mnt/work
# A root without another user's number is refused by the real-time part, which wants a socket that it may write.
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 HOME=/mnt/home RTAPI_UID=65534 RTAPI_FIFO_PATH=/mnt/tmp/rtapi \
  LD_LIBRARY_PATH=/usr/lib:/usr/lib/x86_64-linux-gnu "$@"
