// The members of the JSON of a record, for the reference of the manual. They come from the lists of members by which the JSON is
// written and read: see reports/record.h.
#pragma once

#include <string>
#include <vector>

namespace softland {

/// A member of a record of JSON.
struct JsonMember {
  /// Key of the member. The key of a list ends in "[]", and that of members with any names in ".NAME".
  std::string key;
  std::string type;                      ///< "number", "list of texts", "record"
  std::string about;                     ///< meaning of the member; may be empty
  std::string record;                    ///< name of the C++ type of a record, which tells equal records; empty for other members
  std::vector<JsonMember> members = {};  ///< members of a record, or of each record of a list
};

/// Returns the members of the JSON of a record, such as ReleaseRecord. It is defined beside json_of() of that record.
template <class Record>
[[nodiscard]] std::vector<JsonMember> json_members();

}  // namespace softland
