#!/bin/bash
# slurm_test.sh PROGRAM SCENE [RESULT]: the script that `softland slurm` prints, on a Slurm of one machine that is started for it.
#
# An array of eight parts is submitted, one of them is killed in its work and submitted again alone; what is merged then has the bits of a
# study that was never parted. Needs root and the packages slurmctld, slurmd, slurm-client and munge; ends with 77 where something of that
# is missing. RESULT: file for what was measured.
set -u
program=$(readlink -f -- "$1") scene=$(readlink -f -- "$2") result=${3:-/dev/stdout}
parts=8 killed=3

skip() { echo "skipped: $*" && exit 77; }
needs='needs: slurmctld slurmd slurm-client munge'
[ "$(id -u)" = 0 ] || needs="$needs root"
for tool in munged slurmctld slurmd sbatch squeue scontrol; do
  command -v "$tool" >/dev/null || skip "no Slurm; $needs"
done
[ "$(id -u)" = 0 ] || skip 'no right to start Slurm; needs: root'

# A folder whose name a careless script would not survive.
base=$(mktemp -d "${TMPDIR:-/tmp}/softland-slurm.XXXXXX")
work="$base/it's a \"map\" & more"
server=$base/server
mkdir -p "$work" "$server/state" "$server/spool"
chmod 755 "$base" "$server"

# shellcheck disable=SC2317 # called at the end
stop() {
  for daemon in slurmd slurmctld munge; do
    if [ -s "$server/$daemon.pid" ]; then kill "$(cat "$server/$daemon.pid")" 2>/dev/null; fi
  done
  sleep 1
  rm -rf -- "$base"
}
trap stop EXIT

fail() {
  echo "FAILED: $*" >&2
  tail -n 20 "$server"/*.log "$work"/*/*.log >&2 2>/dev/null
  exit 1
}

wait_for() {  # SECONDS WHAT COMMAND...: until it succeeds
  local left=$((10 * $1)) what=$2
  shift 2
  until "$@"; do
    left=$((left - 1))
    [ "$left" -gt 0 ] || fail "waited too long for $what"
    sleep 0.1
  done
}

start_slurm() {
  local host
  host=$(hostname -s)
  head -c 1024 /dev/urandom >"$server/munge.key"
  chmod 600 "$server/munge.key"
  munged --force --key-file="$server/munge.key" --socket="$server/munge.socket" --pid-file="$server/munge.pid" \
    --log-file="$server/munge.log" --seed-file="$server/munge.seed" 2>>"$server/start.log" || skip 'no munged that starts here'
  cat >"$server/slurm.conf" <<CONF
ClusterName=softland
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket=$server/munge.socket
SlurmUser=root
StateSaveLocation=$server/state
SlurmdSpoolDir=$server/spool
SlurmctldPidFile=$server/slurmctld.pid
SlurmdPidFile=$server/slurmd.pid
SlurmctldLogFile=$server/slurmctld.log
SlurmdLogFile=$server/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
SchedulerParameters=bf_interval=1,sched_min_interval=0,batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$server/slurm.conf
  { slurmctld && slurmd; } 2>>"$server/start.log" || fail 'slurmctld or slurmd does not start'
  wait_for 60 'an idle node' sh -c 'sinfo -h -o %t 2>/dev/null | grep -q idle'
}

start_slurm
cd "$work" || exit 1

# 8 x 60 points of a tenth of a second or less.
cat >plan.toml <<PLAN
[plan]
scene = "$scene"
set = ["simulate.duration=200 us"]
vary = ["structure.length=245 um:275 um:24", "gap.contact=1.6 um:2.4 um:20"]
PLAN

"$program" slurm plan.toml --tasks "$parts" --out map.sqlite >job.sh || fail 'no script'
if command -v shellcheck >/dev/null; then shellcheck job.sh || fail 'shellcheck finds fault with the script'; fi

rows_of() { "$program" status "$1" --json - 2>/dev/null | sed -nE 's/^  "done": ([0-9]+).*/\1/p'; }
# shellcheck disable=SC2317 # called by wait_for
holds_rows() { [ "$(rows_of "$1" || echo 0)" -gt 0 ] 2>/dev/null; }
# shellcheck disable=SC2317
is_over() { [ -z "$(squeue -h -j "$1" 2>/dev/null)" ]; }
state_of() { scontrol show job "$1" | sed -nE 's/^ *JobState=([A-Z_]+).*/\1/p' | head -n 1; }

began=$SECONDS
told=$(bash job.sh) || fail 'the script does not submit itself'
array=$(sed -E 's/^parts: job ([0-9]+), .*/\1/' <<<"$told")
merge=$(sed -E 's/.*merge: job ([0-9]+), .*/\1/' <<<"$told")
part=$work/map-parts/part-$killed-of-$parts.sqlite
wait_for 300 "rows in $part" holds_rows "$part"
writer=$("$program" status "$part" --json - | sed -nE 's/.*"writer": "process ([0-9]+) on .*/\1/p')
kill -KILL "$writer" || fail 'the part could not be killed'
wait_for 300 'the other parts' is_over "$array"
left=$(rows_of "$part")
[ "$(state_of "${array}_$killed")" = FAILED ] || fail "the killed part is $(state_of "${array}_$killed")"
wait_for 60 'the merge to be given up' sh -c "scontrol show job $merge | grep -q JobState=CANCELLED"
[ ! -e map.sqlite ] || fail 'parts were merged though one is missing'
{ [ "$left" -gt 0 ] && [ "$left" -lt 60 ]; } || fail "the killed part holds $left rows: it was not killed in its work"

told=$(bash job.sh "$killed") || fail 'the part cannot be submitted again alone'
merge=$(sed -E 's/.*merge: job ([0-9]+), .*/\1/' <<<"$told")
wait_for 300 'the merge' is_over "$merge"
[ "$(state_of "$merge")" = COMPLETED ] || fail "the merge is $(state_of "$merge")"
parted=$((SECONDS - began))

began=$SECONDS
"$program" explore plan.toml --out whole.sqlite --quiet >/dev/null || fail 'the study in one piece'
whole=$((SECONDS - began))
columns=$("$program" table whole.sqlite --csv | sed -n 1p),content,extra
for store in map whole; do "$program" table "$store.sqlite" --csv --select "$columns" >"$store.csv" || fail "table of $store"; done
cmp map.csv whole.csv || fail 'the merged store has other bits than the one that was never parted'

{
  echo "$(($(wc -l <whole.csv) - 1)) points, $(head -n 1 whole.csv | tr ',' '\n' | wc -l) columns: the merged store of $parts parts and the one in one piece have the same bits:"
  sha256sum map.csv whole.csv
  echo "Part $killed was killed with $left of 60 rows, submitted again alone, and kept those rows."
  echo "Submission to merge, with the kill: $parted s; in one piece: $whole s. $(scontrol --version)"
} >"$result"
exit 0
