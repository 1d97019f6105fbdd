// The report of a result, made again.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/scenes.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "reports/result_reader.h"
#include "reports/text.h"

namespace softland::apps {
namespace {

int report_verb(const Common& given, const std::string& result) {
  const std::filesystem::path path =
      is_folder(result) ? std::filesystem::path(result) / "result.json" : std::filesystem::path(result);
  const nlohmann::json j = load_result(path);
  require_reportable(j, path.string());
  Common c = given;
  if (c.out.empty()) c.out = path.has_parent_path() ? path.parent_path().string() : ".";
  const std::vector<std::string> files{"report.html", "gap.svg"};
  ResultFolder folder = *claim_places(c, files);
  const Result r = read_result(j);
  write_report(folder, r);
  folder.publish(false);
  print(text_report(r) + left_in(c.out, files));
  return exit_done;
}

}  // namespace

void add_report(Verb& verb) {
  const auto result = std::make_shared<std::string>();
  verb.positional("RESULT", *result, "folder that --out named, or its result.json");
  verb.with_out("folder to write them to (default: beside the result)");
  verb.footer("Example:\n  softland report softland-out");
  verb.runs([result](const Common& common) { return report_verb(common, *result); });
}

}  // namespace softland::apps
