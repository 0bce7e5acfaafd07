# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
#
# Shared by refit_slurm, refit_parallel and refit_task, which source it.

# The user's options with their defaults; refit_slurm and refit_parallel add their own.
declare -A option=(["manifest"]='' ["models"]='' ["store"]='' ["shards"]='' ["dir"]='' ["all"]=false)

# refuse CODE SENTENCE
refuse() {
  echo "${0##*/}: $2." >&2
  exit "$1"
}

# Reads --name value, --name=value and --all into option[name], which must have a default for every valid name. The
# arguments after -- go into tool_flags: parse_options "$@"
parse_options() {
  local name
  tool_flags=()
  while (($# > 0)); do
    case $1 in
      --help | -h)
        sed -n '4,/^set /{/^set /d; s/^# \?//; p}' "$0"
        exit 0
        ;;
      --)
        tool_flags=("${@:2}")
        return
        ;;
      --*) name=${1#--} name=${name%%=*} ;;
      *) refuse 2 "'$1' belongs to no option" ;;
    esac
    [[ " ${!option[*]} " == *" $name "* ]] || refuse 2 "there is no option '--$name'; --help names those there are"
    if [[ $1 == --all ]]; then
      option["all"]=true
      shift
    elif [[ $1 == *=* ]]; then
      option["$name"]=${1#*=}
      shift
    else
      (($# > 1)) || refuse 2 "$1 is without its value"
      option["$name"]=$2
      shift 2
    fi
  done
}

# require_counts NAME...: checks that these options are whole numbers from 1.
require_counts() {
  local name
  for name in "$@"; do
    [[ ${option[$name]} =~ ^[1-9][0-9]{0,5}$ ]] || refuse 2 "--$name is '${option[$name]}'; it is a whole number from 1"
  done
}

# Checks the request itself, and makes its paths absolute.
check_request() {
  local name flag
  for name in manifest models store shards; do
    [[ -n ${option[$name]} ]] || refuse 2 "--$name is missing"
  done
  [[ ${option[all]} == true || ${option[all]} == false ]] || refuse 2 "--all takes no value"
  require_counts shards cpus
  for flag in "${tool_flags[@]}"; do
    [[ $flag == -* ]] || continue
    name=${flag#-}  # gflags accepts a single dash too
    case ${name#-} in
      data | data=* | force* | manifest* | model* | scratch* | shard* | store* | threads*)
        refuse 2 "$flag stands behind --, but is not for you to give there"
        ;;
    esac
  done
  option["dir"]=${option[dir]:-${option[store]}.shards}
  for name in manifest store dir; do
    # Not realpath: another node may reach the same folder through another link.
    [[ ${option[$name]} == /* ]] || option["$name"]=$PWD/${option[$name]}
  done
  [[ -f ${option[manifest]} && -r ${option[manifest]} ]] || refuse 3 "${option[manifest]} cannot be read; check the path"
  [[ -d ${option[store]%/*}/ ]] || refuse 73 "${option[store]} cannot be written; there is no such folder"
  mkdir -p -- "${option[dir]}/logs" 2> /dev/null || refuse 73 "${option[dir]} cannot be made; check the path and its permissions"
}

# Sets tool to refit_pendulums: $REFIT_PENDULUMS, or the one delivered with these scripts or built next to them, or the
# one in PATH.
find_tool() {
  local here candidate
  here=$(dirname -- "${BASH_SOURCE[0]}")
  for candidate in "${REFIT_PENDULUMS:-$here/../bin/refit_pendulums}" "$here"/../../{bin,build/release/bin}/refit_pendulums \
    "$(command -v refit_pendulums || true)"; do
    if [[ -f $candidate && -x $candidate ]]; then
      tool=$(cd -- "$(dirname -- "$candidate")" && pwd)/${candidate##*/}
      return
    fi
    [[ -z ${REFIT_PENDULUMS:-} ]] || refuse 69 "REFIT_PENDULUMS is '$REFIT_PENDULUMS', which is no program"
  done
  refuse 69 "there is no refit_pendulums beside this script nor on PATH; let REFIT_PENDULUMS name it"
}

# Renames shards that were fitted for another request, or that are to be checked again (--all), to *.part. A task starts
# from such a file and keeps its valid results. Shards of another shard count do not get here: `missing` rejects these
# before.
set_aside_other_shards() {
  local file=${option[dir]}/request request shard
  request=$("$tool" --version && sha256sum < "${option[manifest]}" && printf '%q ' "${option[models]}" "${tool_flags[@]}")
  if [[ ${option[all]} == true || ! -f $file || $(< "$file") != "$request" ]]; then
    for shard in "${option[dir]}"/shard-*.sqlite; do
      if [[ -f $shard ]]; then mv -- "$shard" "$shard.part"; fi
    done
  fi
  printf '%s\n' "$request" > "$file"
}

# Sets missing to the shards that do not exist yet, as in 3,17-20; empty if all exist.
find_missing() {
  local list
  list=$("$tool" missing --shard_dir "${option[dir]}" --shard_count "${option[shards]}")
  # shellcheck disable=SC2034  # the scripts that source this read it
  missing=$(awk -v RS='[,\n]' '
    function flush() {
      if (first == "") return
      printf "%s%s", separator, first == last ? first : first "-" last
      separator = ","
    }
    first != "" && $1 == last + 1 { last = $1; next }
    { flush(); first = last = $1 }
    END { flush() }' <<< "$list")
}

# Sets missing to the shards for which this request needs a task.
find_work() {
  find_missing
  set_aside_other_shards
  find_missing
}

# run_to_end COMMAND...: runs it, forwards SIGTERM and Ctrl-C, and still waits for its end. The exit code is the
# command's, or 75 (try again) if the signal came before the command could handle it.
run_to_end() {
  local process='' stopped=false code=0
  trap 'stopped=true; if [[ -n $process ]]; then kill -TERM "$process" 2> /dev/null || true; fi' TERM INT
  "$@" &
  process=$!
  if $stopped; then kill -TERM "$process"; fi
  wait "$process" || code=$?
  # A signal ends the wait, not the command.
  while kill -0 "$process" 2> /dev/null; do
    code=0
    wait "$process" || code=$?
  done
  trap - TERM INT
  if $stopped && ((code > 128)); then code=75; fi
  return "$code"
}
