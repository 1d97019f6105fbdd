// An invalid key of a scene file, with its position, for programs that show the position.
#pragma once

#include <source_location>
#include <string>
#include <utility>

#include "base/require.h"

namespace softland {

/// Thrown for a key or section of a scene that breaks a rule. The message contains key, file and line as well.
class InvalidKey : public InvalidInput {
 public:
  struct Place {
    std::string key;   ///< path of the invalid key, such as "gap.contact"
    std::string file;  ///< name of the scene file in messages; empty where a command-line option set the key
    int line = 0;      ///< line of the key in the scene file, counted from 1; 0 where the line is not known
  };
  InvalidKey(const std::string& message, Place place, std::source_location where = std::source_location::current())
      : InvalidInput(message, where), place_(std::move(place)) {}
  [[nodiscard]] const Place& place() const noexcept { return place_; }

 private:
  Place place_;
};

}  // namespace softland
