#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/require.h"
#include "base/shortened.h"
#include "store/place.h"
#include "store/study_store.h"
#include "store/tables.h"

namespace softland {

using namespace internal;

namespace {

// SQL functions that an expression of --where may call; they have no side effects and are fast.
constexpr std::array<std::string_view, 26> harmless{
    "abs",   "acos", "asin", "atan",  "atan2", "ceil", "coalesce", "cos",    "exp", "floor", "glob", "ifnull", "iif",
    "instr", "like", "ln",   "log10", "lower", "max",  "min",      "nullif", "pow", "round", "sin",  "sqrt",   "upper"};

int authorize(void*, int action, const char* first, const char* second, const char*, const char*) {
  const auto allowed = [](bool is) { return is ? SQLITE_OK : SQLITE_DENY; };
  if (action == SQLITE_SELECT) return SQLITE_OK;
  if (action == SQLITE_READ) return allowed(first != nullptr && std::string_view(first) == "results");
  if (action == SQLITE_FUNCTION)
    return allowed(second != nullptr && std::find(harmless.begin(), harmless.end(), std::string_view(second)) != harmless.end());
  return SQLITE_DENY;
}

// Returns true if an SQL expression stays one expression inside the parentheses "WHERE (...)": its parentheses are balanced,
// none closes an outer one, and it has no comment and no second statement. Text in quotes is skipped.
bool is_closed(std::string_view where) {
  int depth = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    const char c = where[i];
    if (c == '\'' || c == '"') {
      i = where.find(c, i + 1);
      if (i == std::string_view::npos) return false;
    }
    const std::string_view two = where.substr(i, 2);
    if (c == ';' || two == "--" || two == "/*") return false;
    depth += (c == '(' ? 1 : 0) - (c == ')' ? 1 : 0);
    if (depth < 0) return false;
  }
  return depth == 0;
}

std::string lower(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return small;
}

bool has_word(std::string_view text, std::string_view word) {
  const auto part = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !part(text[at - 1])) && (end == text.size() || !part(text[end]))) return true;
  }
  return false;
}

void require_where(bool holds, const std::string& where, const std::string& reason) {
  require(holds, [&] { return fmt::format("--where \"{}\": {}", shortened(where), reason); });
}

std::string columns_of(const StoredPlan& plan) {
  std::vector<std::string_view> names{"point", "status", "reason"};
  for (const StoredColumn& column : plan.columns) names.push_back(column.key);
  return fmt::format("{}", fmt::join(names, ", "));
}

// Checks the expression of --where before it becomes part of an SQL statement.
void check_where(const Database& database, const StoredPlan& plan, const std::string& where) {
  require_where(is_closed(where), where, "must be a single expression of columns, with closed parentheses and quotes");
  const std::string words = lower(where);
  for (const char* word : {"select", "pragma", "attach"})
    require_where(!has_word(words, word), where, fmt::format("must be an expression of columns, without {}", word));
  sqlite3_stmt* statement = nullptr;
  const std::string sql = "SELECT 1 FROM results WHERE (" + where + "\n)";
  sqlite3_set_authorizer(database.handle(), authorize, nullptr);
  const int code = sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement, nullptr);
  const std::string reason = code == SQLITE_OK ? "" : sqlite3_errmsg(database.handle());
  const int parameters = code == SQLITE_OK ? sqlite3_bind_parameter_count(statement) : 0;
  sqlite3_finalize(statement);
  sqlite3_set_authorizer(database.handle(), nullptr, nullptr);
  if ((code & 0xFF) == SQLITE_CORRUPT) database.fail(code);
  require_where(code == SQLITE_OK, where, fmt::format("{}; choose from the columns {}", reason, columns_of(plan)));
  require_where(parameters == 0, where, "must not contain \"?\", \":\", \"@\" or \"$\"");
}

}  // namespace

class StudyReader::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& path) : path_(path), database_(open_to_read(path)) {
    check_schema(*database_);
    current_ = current_plan(*database_);
  }
  std::filesystem::path path_;
  std::unique_ptr<const Database> database_;
  NumberedPlan current_;
};

StudyReader::StudyReader(const std::filesystem::path& path) : implementation_(std::make_unique<Implementation>(path)) {}
StudyReader::~StudyReader() = default;
StudyReader::StudyReader(StudyReader&&) noexcept = default;
StudyReader& StudyReader::operator=(StudyReader&&) noexcept = default;

const std::filesystem::path& StudyReader::path() const { return implementation_->path_; }

const StoredPlan& StudyReader::plan() const { return implementation_->current_.plan; }

std::vector<StoredSession> StudyReader::sessions() const { return sessions_in(*implementation_->database_); }

std::map<std::string, std::int64_t> StudyReader::by_status() const {
  return tally_of(*implementation_->database_, implementation_->current_.number);
}

void StudyReader::read(const std::function<void(const StoredRow&)>& row, const StudyQuery& query,
                       const Progress& progress) const {
  const Database& database = *implementation_->database_;
  if (!query.where.empty()) check_where(database, plan(), query.where);
  try {
    RowReader rows(database, implementation_->current_, RowReader::Of::rows, query.where);
    const InterruptibleQuery interruptible(database, progress);
    while (rows.next()) row(rows.row());
  } catch (const StatementFailed& error) {
    require_where(query.where.empty(), query.where, error.reason());
    throw;
  }
}

}  // namespace softland
