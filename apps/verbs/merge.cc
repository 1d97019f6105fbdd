// Verb `merge`: joins the database files of the parts of a study into one file.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/stores.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/printable.h"
#include "base/require.h"
#include "document/quantity.h"
#include "reports/origin.h"

namespace softland::apps {
namespace {

struct MergeRequest {
  std::string part;
  std::vector<std::string> more;
  bool complete = false;
};

int merge_verb(const Common& c, const MergeRequest& request) {
  require(!c.out.empty(), "--out is required: it names the merged store");
  std::vector<std::filesystem::path> parts{request.part};
  parts.insert(parts.end(), request.more.begin(), request.more.end());
  for (const std::filesystem::path& part : parts) {
    if (!c.quiet && writer_of(part))
      print_note(fmt::format("{}: another process is still writing to it: {}", part.string(), *writer_of(part)));
  }
  std::optional<ShownWork> work(std::in_place, c.quiet, c.stop);
  const Merged merged =
      merge_studies(parts, c.out, stored_origin(c.command), {.complete = request.complete, .progress = work->progress()});
  work.reset();
  for (const std::string& note : merged.notes) print_note(note);
  if (!merged.written) return exit_no_success;
  print(fmt::format("{} of {} points from {} {} in {}\n", internal::whole(static_cast<double>(merged.rows)),
                    internal::whole(static_cast<double>(merged.plan.points)), parts.size(), parts.size() == 1 ? "part" : "parts",
                    printable_line(c.out)));
  return exit_done;
}

}  // namespace

void add_merge(Verb& verb) {
  const auto request = std::make_shared<MergeRequest>();
  verb.positional("PART", request->part, "store of a part of a study");
  verb.more("PARTS", request->more, "further stores of parts");
  verb.with_out_file("store to write; an existing file is not replaced");
  verb.flag("--complete", request->complete, "if points are missing, write nothing and end with exit status 4");
  verb.with_quiet();
  verb.footer(
      "All parts must have the same plan. A point that several parts hold must be identical to the last bit in all of them.\n"
      "Example:\n  softland merge map-parts/*.sqlite --out map.sqlite");
  verb.runs([request](const Common& common) { return merge_verb(common, *request); });
}

}  // namespace softland::apps
