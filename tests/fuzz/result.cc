#include "document/svg.h"
#include "document/text.h"
#include "reports/closing_charts.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "reports/mode_table_report.h"
#include "reports/record_file.h"
#include "tests/fuzz/scene_checks.h"
#include "tests/fuzz/targets.h"
#include "tests/support/xml.h"
#include "verbs/study.h"

namespace softland::fuzz {
namespace {

using nlohmann::json;

std::size_t scripts(std::string_view page) {
  std::size_t count = 0;
  for (std::size_t at = page.find("<script"); at != std::string_view::npos; at = page.find("<script", at + 1)) ++count;
  return count;
}

// Returns the text that `report` prints.
std::string told(const std::string& kind, const json& read) {
  if (kind == "modes") return text_of(read_modes(read));
  for (const verbs::Study& study : verbs::all_studies()) {
    if (kind == study.name && study.shown_again) return study.shown_again(read).text;
  }
  return "of no study";
}

}  // namespace

void result(std::string_view input) {
  json read;
  if (!accepted([&] { read = parse_record(input, "fuzz.json"); })) return;
  accepted([&] { check(!told(read["kind"].get<std::string>(), read).empty(), "a record without words"); });
  if (!accepted([&] { read = parse_closing(input, "fuzz.json"); })) return;
  check(parse_closing(read.dump(), "written.json") == read, "a result changes when it is read again");

  const ClosingRecord shown = read_closing(read);
  static const std::size_t own_scripts = scripts(page_html(closing_document({})));
  check(scripts(page_html(closing_document(shown))) <= own_scripts, "a result brings a script into its page");
  const std::string fault = test::xml_fault(svg_gap_chart(shown));
  check(fault.empty(), "the picture of a result is not XML: " + fault);
  static_cast<void>(terminal_text(closing_document(shown)));

  const auto scene = read.find("scene_toml");
  if (scene == read.end() || !scene->is_string()) return;
  accepted([&] { check_scene(SceneFile::parse(scene->get<std::string>(), "fuzz.json", "/nonexistent")); });
}

}  // namespace softland::fuzz
