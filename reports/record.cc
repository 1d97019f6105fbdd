#include "reports/record.h"

#include <fmt/format.h>

#include <string>

#include "base/printable.h"
#include "base/require.h"
#include "base/shortened.h"

namespace softland {

void internal::require_same(const json& written, const json& read) {
  const json changes = json::diff(read, written);
  if (changes.empty()) return;
  // JSON pointer of the first difference between two records: "/touch/least_time_s".
  std::string key = changes[0]["path"].get<std::string>();
  for (char& letter : key) {
    if (letter == '/') letter = '.';
  }
  if (!key.empty()) key.erase(0, 1);
  key = shortened(printable_line(key));
  const std::string how = changes[0]["op"];
  require(how != "add", [&] { return fmt::format("\"{}\" is missing", key); });
  require(how != "remove", [&] { return fmt::format("\"{}\" is not known", key); });
  throw InvalidInput(fmt::format("\"{}\" is not as softland writes it", key));
}

}  // namespace softland
