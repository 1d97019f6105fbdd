#include "apps/output.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "apps/exit_status.h"
#include "apps/streams.h"
#include "base/companion.h"
#include "base/require.h"
#include "base/write_whole.h"
#include "document/text.h"
#include "reports/record_file.h"

namespace softland::apps {

namespace fs = std::filesystem;
using nlohmann::json;

// Throws InvalidInput if the file of --json cannot be written, is standard output under a path such as /dev/stdout, or has a
// name that the folder of --out reserves for unfinished results.
void check_json_place(const std::string& file, const fs::path& folder) {
  if (!folder.empty()) {
    const fs::path inside =
        fs::weakly_canonical(fs::absolute(file)).lexically_relative(fs::weakly_canonical(fs::absolute(folder)));
    const std::string first = inside.empty() ? std::string() : inside.begin()->string();
    require(first != "softland.lock" && !first.starts_with("unfinished"),
            fmt::format("--json {}: this name is reserved for unfinished results of a run; name another file", file));
  }
  check_writable(file);
  struct stat out {
  }, there{};
  const bool is_output = ::fstat(STDOUT_FILENO, &out) == 0 && ::stat(file.c_str(), &there) == 0 && out.st_dev == there.st_dev &&
                         out.st_ino == there.st_ino;
  require(!is_output, fmt::format("--json {}: is the standard output of this run; use --json -", file));
}

std::optional<ResultFolder> reserve_outputs(const Common& c, const std::vector<std::string>& files,
                                            const std::vector<std::string>& kept) {
  const bool has_file = !c.json.empty() && c.json != "-";
  std::optional<ResultFolder> folder;
  if (!c.out.empty()) folder.emplace(c.out, "--out " + c.out, c.command, files, kept);
  if (has_file) check_json_place(c.json, folder ? folder->path() : fs::path());
  for (const std::string& name : folder ? files : std::vector<std::string>()) {
    const fs::path file = folder->path() / name;
    require(!has_file || fs::weakly_canonical(c.json) != fs::weakly_canonical(file),
            fmt::format("--json {}: is the {} that --out writes; name another file", c.json, name));
    require(!has_file || file.extension() != ".sqlite" || !is_companion(c.json, file),
            fmt::format("--json {}: is a companion file of the store {}; name another file", c.json, file.string()));
  }
  return folder;
}

std::string files_written(const fs::path& folder, const std::vector<std::string>& files) {
  return "\n" + wrapped(fmt::format("In {}: {}", folder.string(), fmt::join(files, ", "))) + "\n";
}

void print_json_or(const Common& c, const json& data, const std::string& text) {
  if (!c.json.empty() && c.json != "-") write_whole(c.json, json_text(data, 2));
  print(c.json == "-" ? json_text(data, 2) : text);
}

int exit_status_of(verbs::Ending ending) {
  switch (ending) {
    case verbs::Ending::done:
      return exit_done;
    case verbs::Ending::no_success:
      return exit_no_success;
    case verbs::Ending::numerical_failure:
      return exit_numerical_failure;
    case verbs::Ending::interrupted:
      break;
  }
  return exit_interrupted;
}

}  // namespace softland::apps
