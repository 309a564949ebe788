#!/bin/bash
# Stops what up.sh started in DIR, by the numbers that it wrote down.
dir=$1
for file in "$dir"/slurmd.n1.pid "$dir"/slurmd.n2.pid "$dir"/slurmctld.pid; do
    [ -s "$file" ] && kill "$(cat "$file")"
done
[ -e "$dir/own_munge" ] && kill "$(cat /run/munge/munged.pid)"
sleep 0.3
true
