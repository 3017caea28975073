# shellcheck shell=bash
# Sourced by ./quickstart and ./check: the compiler and the number of parallel jobs that suit this machine.

# Where the system's g++ is older than 12, take g++-12 unless the caller has chosen.
if [[ -z ${CXX:-} ]] && command -v g++ >/dev/null && (($(g++ -dumpversion | cut -d. -f1) < 12)) &&
  command -v g++-12 >/dev/null; then
  export CXX=g++-12
fi

# One job for each processor, and no more than one for each 1.5 GB of free memory.
build_jobs() {
  local jobs memory
  jobs=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN)
  memory=$(awk '/MemAvailable/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || true)
  if [[ -n $memory ]] && ((memory < jobs)); then jobs=$memory; fi
  ((jobs >= 1)) || jobs=1
  printf '%s\n' "$jobs"
}
