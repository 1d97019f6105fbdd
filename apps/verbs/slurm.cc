// Verb `slurm`: prints the job script of a study for a cluster.
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/exit_status.h"
#include "apps/stores.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/require.h"
#include "base/shell_word.h"
#include "config/plan.h"
#include "store/study_store.h"
#include "studies/exploration/stored_exploration.h"
#include "verbs/options.h"
#include "verbs/points.h"

namespace softland::apps {
namespace {

namespace fs = std::filesystem;

// Largest number of jobs that the user may request in one array of jobs; it exceeds what any cluster permits.
constexpr std::uint64_t most_tasks = 100'000;

struct SlurmRequest {
  std::string plan;
  std::optional<std::string> tasks, processors;
};

Plan plan_of(const std::string& file) {
  const auto of_file = [&] {
    const SceneFile text = SceneFile::load(file);
    require(is_plan(text), [&] { return fmt::format("{}: must be a store, or a plan file, which has a section [plan]", file); });
    return read_plan(text);
  };
  PlanRequest request = is_store(file) ? exploration_in(StudyReader(file)) : of_file();
  complete(request, verbs::studies_of_points());
  return Plan(request);
}

// Returns the first part of the job script; only this part depends on the study that the jobs run.
std::string head(const Common& c, const Plan& plan, std::uint64_t tasks, std::uint64_t processors, const fs::path& out) {
  const std::string digest = content_key(plan.text()).hexadecimal();
  const fs::path parts = out.parent_path() / (out.stem().string() + "-parts");
  return fmt::format(
      "#!/bin/bash\n"
      "# {} points in {} parts (plan {}), by: {}\n"
      "#   bash THIS          submits all parts, and a merge that begins when all of them are done\n"
      "#   bash THIS 3,7-9    submits these parts again, and the merge; points that they hold are not computed again\n"
      "#   sbatch THIS        submits the parts alone; bash THIS merge merges them here\n"
      "# Settings of the cluster are taken from the environment: SBATCH_PARTITION, SBATCH_ACCOUNT, "
      "SBATCH_TIMELIMIT (man sbatch).\n"
      "#SBATCH --job-name=softland\n"
      "#SBATCH --array=1-{}\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --requeue\n"
      "#SBATCH --open-mode=append\n"
      "# shellcheck disable=SC2016 # file names are literal\n"
      "set -eu\n\n"
      "softland={}\n"
      "parts={} # folder that all machines can access\n"
      "out={}\n"
      "count={} # number of parts of this study, even if only some are submitted\n\n"
      "write_plan() {{\n"
      "  cat <<'end of plan {}'\n{}{}end of plan {}\n"
      "}}\n",
      plan.points(), tasks, digest, c.command, tasks, processors, shell_word(fs::read_symlink("/proc/self/exe").string()),
      shell_word(parts.string()), shell_word(out.string()), tasks, digest, plan.text(), plan.text().ends_with('\n') ? "" : "\n",
      digest);
}

constexpr std::string_view body = R"bash(
part() { printf '%s/part-%d-of-%d.sqlite' "$parts" "$1" "$count"; }

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
  mkdir -p -- "$parts"
  plan=$parts/plan-$SLURM_ARRAY_TASK_ID.toml
  write_plan >"$plan"
  status=0
  "$softland" explore "$plan" --shard "$SLURM_ARRAY_TASK_ID/$count" --resume --jobs "${SLURM_CPUS_PER_TASK:-1}" \
    --out "$(part "$SLURM_ARRAY_TASK_ID")" || status=$?
  [ "$status" != 4 ] || status=0 # a part is done even if no switch closes in it
  exit "$status"
fi

if [ "${1:-}" = merge ]; then
  set --
  for ((i = 1; i <= count; ++i)); do set -- "$@" "$(part "$i")"; done
  exec "$softland" merge "$@" --complete --out "$out"
fi

if [ -e "$out" ]; then
  printf '%s exists already\n' "$out" >&2
  exit 2
fi
script=$(readlink -f -- "$0")
mkdir -p -- "$parts"
array=$(sbatch --parsable --array="${1:-1-$count}" --chdir="$parts" --output=part-%a.log "$script")
array=${array%%;*}
merge=$(sbatch --parsable --job-name=softland-merge --dependency="afterok:$array" --kill-on-invalid-dep=yes \
  --chdir="$parts" --output=merge.log --wrap="exec bash $(printf '%q' "$script") merge")
printf 'parts: job %s, merge: job %s, logs in %s\n' "$array" "${merge%%;*}" "$parts"
)bash";

int slurm_verb(const Common& c, const SlurmRequest& request) {
  require(request.tasks.has_value(), "--tasks is required: it gives the number of parts of the study");
  const auto tasks = verbs::whole_number<std::uint64_t>("--tasks", *request.tasks, {.least = 1});
  const auto processors =
      request.processors ? verbs::whole_number<std::uint64_t>("--cpus", *request.processors, {.least = 1}) : 1;
  const Plan plan = plan_of(request.plan);
  require(tasks == 1 || !plan.is_search(),
          "--tasks: a search for a Pareto front depends on its earlier points and cannot be divided");
  require(tasks <= most_tasks && tasks <= plan.points(), [&] {
    return fmt::format("--tasks {0}: must be at most {2} for a study of {1} points", tasks, plan.points(),
                       std::min(most_tasks, plan.points()));
  });
  const fs::path out = fs::absolute(c.out.empty() ? "softland-out.sqlite" : c.out).lexically_normal();
  require(!fs::exists(fs::symlink_status(out)),
          [&] { return fmt::format("--out {}: exists already; name another file", out.string()); });
  print(head(c, plan, tasks, processors, out) + std::string(body));
  return exit_done;
}

}  // namespace

void add_slurm(Verb& verb) {
  const auto request = std::make_shared<SlurmRequest>();
  verb.positional("PLAN", request->plan, "plan file, or a store, which holds its plan");
  verb.optional("--tasks", request->tasks, "N", "number of parts, each a task of the job array");
  verb.optional("--cpus", request->processors, "N", "number of processors and threads of each task (default: 1)");
  verb.with_out_file("merged store (default: softland-out.sqlite); the folder of the parts lies beside it");
  verb.footer(
      "The script submits the parts and a merge that runs after all of them. It calls this program by its path, which all\n"
      "machines must be able to access. See docs/scale.md.\n"
      "Example:\n  softland slurm map.toml --tasks 100 --out map.sqlite > map.sh && bash map.sh");
  verb.runs([request](const Common& common) { return slurm_verb(common, *request); });
}

}  // namespace softland::apps
