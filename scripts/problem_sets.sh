# Sourced by ./run: the study's problem sets, generated.

# Hash of all that a generated set depends on: program, specifications, robot, seed, number of problems.
# problem_set_key PROGRAM SPEC ROBOT SEED COUNT
problem_set_key() {
  local program=$1 spec=$2 robot=$3 seed=$4 count=$5
  {
    find "$program" "$(dirname "$spec")"/*.yaml "$robot" -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum
    printf '%s\n' "$spec" "$seed" "$count"
  } | sha256sum
}

# Makes the problem set of a specification in the folder OUT, unless it is there already and nothing that it depends
# on has changed. OUT.key holds the hash. OUT is complete or not there at all.
# ensure_problem_set PROGRAM SPEC ROBOT SEED COUNT OUT
ensure_problem_set() {
  local program=$1 spec=$2 robot=$3 seed=$4 count=$5 out=$6 key
  key=$(problem_set_key "$program" "$spec" "$robot" "$seed" "$count")
  if [ -d "$out" ] && [ "$(cat "$out.key" 2>/dev/null)" = "$key" ]; then return; fi
  say "generating $count problems of $spec in $out"
  rm -rf "$out" "$out.key" "$out.new"
  mkdir -p "$(dirname "$out")"
  "$program" --spec "$spec" --robot "$robot" --count "$count" --seed "$seed" --out "$out.new"
  mv "$out.new" "$out"
  printf '%s\n' "$key" >"$out.key"
}

# The folder of a robot given by path (relative to FROM) or by the name of one that ships, as the programs find it
# (robot_model/shipped_robots.h).
# robot_folder ROBOT FROM
robot_folder() {
  (cd "$2" && [ -f "$1/robot.yaml" ] && realpath "$1") && return
  [ -f "robots/$1/robot.yaml" ] ||
    die "--robot $1: there is no such folder with a robot.yaml, and no robot of that name ships; those are: $(cd robots && echo *)"
  printf '%s/robots/%s\n' "$PWD" "$1"
}

# Names of the sets that are compared for a robot by default: the study's for the Fetch, problems/*_NAME.yaml for others.
# generated_sets NAME
generated_sets() {
  local spec
  if [ "$1" = fetch ]; then
    printf '%s\n' shelf_zero_test shelf_height_test shelf_height_rot_test
    return
  fi
  for spec in problems/*_"$1".yaml; do
    [ -e "$spec" ] || die "no problem sets are generated for the robot '$1'; give some with --problems DIR"
    basename "$spec" .yaml
  done
}
