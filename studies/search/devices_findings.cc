#include "studies/search/devices_findings.h"

#include <algorithm>

namespace softland {

const DevicesFindings::Row* DevicesFindings::row(std::string_view name) const {
  const auto found = std::ranges::find(rows, name, &Row::name);
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace softland
