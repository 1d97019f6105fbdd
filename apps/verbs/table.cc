// Verb `table`: prints the rows of the database file of a study as CSV or as an aligned table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/exit_status.h"
#include "apps/output.h"
#include "apps/progress.h"
#include "apps/streams.h"
#include "apps/verbs/verbs.h"
#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"
#include "base/split.h"
#include "base/write_whole.h"
#include "document/csv_cell.h"
#include "document/quantity.h"
#include "document/text.h"
#include "store/study_store.h"

namespace softland::apps {
namespace {

struct TableRequest {
  std::string store, where, select;
  bool csv = false;
};

/// A column of the printed table: the key by which --select names the column, and the function that writes a cell.
struct Column {
  std::string key, unit;
  std::function<std::string(const StoredRow&)> csv, shown;
};

Column text_column(const char* key, const std::function<std::string(const StoredRow&)>& text) {
  return {.key = key,
          .unit = "",
          .csv = [text](const StoredRow& row) { return internal::csv_cell(text(row)); },
          .shown = [text](const StoredRow& row) { return printable_line(text(row)); }};
}

// Returns a column of numbers: a number is the shortest text that reads back to the same bits, a missing number is empty.
Column number_column(const StoredColumn& column, std::size_t place) {
  return {
      .key = column.key,
      .unit = column.unit,
      .csv = [place](const StoredRow& row) { return std::isnan(row.values[place]) ? "" : fmt::format("{}", row.values[place]); },
      .shown =
          [place, unit = column.unit](const StoredRow& row) {
            const double value = row.values[place];
            if (unit.empty() || internal::takes_prefix(unit)) return internal::quantity(value, unit, 5);
            return internal::plain_number(value, 5) + (std::isnan(value) ? "" : "\u00a0" + unit);
          }};
}

// Returns all columns of a database file, in the order in which the verb prints them.
std::vector<Column> columns_of(const StoredPlan& plan) {
  std::vector<Column> all{text_column("point", [](const StoredRow& row) { return std::to_string(row.point); })};
  for (std::size_t i = 0; i < plan.columns.size(); ++i) all.push_back(number_column(plan.columns[i], i));
  all.push_back(text_column("status", [](const StoredRow& row) { return row.status; }));
  all.push_back(text_column("reason", [](const StoredRow& row) { return row.reason; }));
  return all;
}

std::vector<Column> selected(const StoredPlan& plan, const std::string& select) {
  std::vector<Column> all = columns_of(plan);
  if (select.empty()) return all;
  // The columns `content` (a hash of the scene) and `extra` (JSON) have long cells: print them only if --select names them.
  all.push_back(text_column("content", [](const StoredRow& row) { return row.content.hexadecimal(); }));
  all.push_back(text_column("extra", [](const StoredRow& row) { return row.extra; }));
  std::vector<Column> chosen;
  for (const std::string& name : split(select, ',')) {
    const auto called =
        std::find_if(plan.columns.begin(), plan.columns.end(), [&](const StoredColumn& c) { return c.name == name; });
    const std::string& key = called == plan.columns.end() ? name : called->key;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Column& c) { return c.key == key; });
    require(found != all.end(), [&] {
      std::vector<std::string_view> keys;
      for (const Column& column : all) keys.push_back(column.key);
      return fmt::format("--select {}: unknown column \"{}\"; choose from {}", shortened(select), shortened(name),
                         fmt::join(keys, ", "));
    });
    chosen.push_back(*found);
  }
  return chosen;
}

using Sink = std::function<void(std::string_view)>;

// Writes the table as CSV. Control characters, which could act on a terminal, are escaped in files as well.
void write_csv(const StudyReader& store, const TableRequest& request, const std::vector<Column>& columns,
               const Progress& progress, const Sink& sink) {
  constexpr std::size_t most = 1 << 16;
  std::string text;
  const auto line = [&](const auto& cell) {
    for (std::size_t i = 0; i < columns.size(); ++i) text += (i == 0 ? "" : ",") + cell(columns[i]);
    text += '\n';
    if (text.size() >= most) sink(printable(std::exchange(text, {})));
  };
  line([](const Column& column) { return column.key; });
  store.read([&](const StoredRow& row) { line([&](const Column& column) { return column.csv(row); }); }, {.where = request.where},
             progress);
  sink(printable(text));
}

void print_table(const StudyReader& store, const TableRequest& request, const std::vector<Column>& columns,
                 const Progress& progress) {
  std::vector<std::size_t> widths;
  std::string header;
  for (const Column& column : columns) {
    widths.push_back(std::max<std::size_t>(column.key.size(), 12) + 1);
    header += internal::right_aligned(column.key, widths.back());
  }
  // Reading the rows also checks the expression that selects rows: nothing is printed before that check.
  std::string text = header + "\n";
  store.read(
      [&](const StoredRow& row) {
        for (std::size_t i = 0; i < columns.size(); ++i)
          text += internal::right_aligned(" " + shortened(columns[i].shown(row), 60), widths[i]);
        text += "\n";
        print(std::exchange(text, {}));
      },
      {.where = request.where}, progress);
  print(text);
}

int table_verb(const Common& c, const TableRequest& request) {
  const StudyReader store(request.store);
  const std::vector<Column> columns = selected(store.plan(), request.select);
  const Progress progress{.stop = c.stop};
  if (c.out.empty() && !request.csv) {
    print_table(store, request, columns, progress);
  } else if (c.out.empty()) {
    write_csv(store, request, columns, progress, print);
  } else {
    require(!is_store(c.out), [&] { return fmt::format("--out {}: is a store and is not replaced; name another file", c.out); });
    write_whole(c.out, [&](const Sink& sink) { write_csv(store, request, columns, progress, sink); });
  }
  return exit_done;
}

}  // namespace

void add_table(Verb& verb) {
  const auto request = std::make_shared<TableRequest>();
  verb.positional("STORE", request->store, "store of a study");
  verb.flag("--csv", request->csv, "print CSV: a header of names with SI units, numbers with all digits, unknown values empty");
  verb.option("--where", request->where, "EXPRESSION", "print only the rows that fulfil this SQL expression of columns");
  verb.option("--select", request->select, "LIST",
              "print these columns in this order; content and extra are printed only if named here");
  verb.with_out_file("write CSV to this file");
  verb.footer(
      "Examples:\n  softland table map.sqlite --csv > map.csv\n"
      "  softland table map.sqlite --where \"bounce_count = 0 and impact_velocity_m_s < 0.01\" --select point,gap.contact\n"
      "A program that reads SQLite needs no CSV: the rows are in the table \"results\" of the store.");
  verb.runs([request](const Common& common) { return table_verb(common, *request); });
}

}  // namespace softland::apps
