// Invalid input is reported by an exception; numerical failure is reported by a status in a result, never by an exception.
#pragma once

#include <concepts>
#include <source_location>
#include <stdexcept>
#include <string>
#include <string_view>

namespace softland {

/// Thrown for input that breaks a stated rule. The message is complete: the message names the value and the rule. The program
/// turns this exception into exit status 2.
class InvalidInput : public std::runtime_error {
 public:
  explicit InvalidInput(const std::string& message, std::source_location where = std::source_location::current())
      : std::runtime_error(message), where_(where) {}
  /// Returns the source location that threw the exception, for debugging; users do not see it.
  [[nodiscard]] const std::source_location& where() const noexcept { return where_; }

 private:
  std::source_location where_;
};

/// Throws InvalidInput with `message` unless `rule_holds`. Write the rule so that NaN fails it. The check is never compiled
/// out.
inline void require(bool rule_holds, std::string_view message, std::source_location where = std::source_location::current()) {
  if (!rule_holds) throw InvalidInput(std::string(message), where);
}

/// Throws InvalidInput with message() unless `rule_holds`; calls message() only if `rule_holds` is false.
template <std::invocable Message>
void require(bool rule_holds, Message&& message, std::source_location where = std::source_location::current()) {
  if (!rule_holds) throw InvalidInput(message(), where);
}

/// Returns the name of an option of a computation between two control characters. with_fields() later removes them, and
/// puts the prefix that the option has for the user, such as "--", in front of the name.
[[nodiscard]] inline std::string requested(std::string_view field) { return '\x02' + std::string(field) + '\x03'; }

/// Returns the text with `before` in front of each field name that requested() has marked: "--" for a command line, "" for a
/// library.
[[nodiscard]] inline std::string with_fields(std::string_view words, std::string_view before) {
  std::string text;
  for (const char c : words) {
    if (c == '\x02') text += before;
    if (c != '\x02' && c != '\x03') text += c;
  }
  return text;
}

/// Thrown for options of a computation, such as OptimizeOptions, that break a rule. The message marks the names of the options
/// by requested(); what() contains the names without marks.
class InvalidRequest : public InvalidInput {
 public:
  explicit InvalidRequest(const std::string& message, std::source_location where = std::source_location::current())
      : InvalidInput(softland::with_fields(message, ""), where), message_(message) {}
  /// Returns the message with `before` in front of each name of an option.
  [[nodiscard]] std::string with_fields(std::string_view before) const { return softland::with_fields(message_, before); }

 private:
  std::string message_;
};

/// Throws InvalidRequest with message() unless `rule_holds`.
template <std::invocable Message>
void require_request(bool rule_holds, Message&& message, std::source_location where = std::source_location::current()) {
  if (!rule_holds) throw InvalidRequest(message(), where);
}

/// Throws InvalidRequest with the message "`field` `given`: " and the text of the rule, from broken(), unless `rule_holds`.
template <std::invocable Broken>
void require_field(bool rule_holds, std::string_view field, std::string_view given, Broken&& broken,
                   std::source_location where = std::source_location::current()) {
  require_request(
      rule_holds, [&] { return requested(field) + ' ' + std::string(given) + ": " + std::string(broken()); }, where);
}

/// Thrown for a parameter of a waveform family or of a probability distribution that breaks a rule.
class InvalidParameter : public InvalidInput {
 public:
  InvalidParameter(std::string_view parameter, const std::string& message, std::source_location where)
      : InvalidInput(message, where), parameter_(parameter) {}
  /// Returns the name of the parameter that breaks the rule.
  [[nodiscard]] const std::string& parameter() const noexcept { return parameter_; }

 private:
  std::string parameter_;
};

/// Throws InvalidParameter with `message` unless `rule_holds`. Write the rule so that NaN fails it.
inline void require_of(std::string_view parameter, bool rule_holds, const std::string& message,
                       std::source_location where = std::source_location::current()) {
  if (!rule_holds) throw InvalidParameter(parameter, message, where);
}

/// Throws InvalidParameter with message() unless `rule_holds`; calls message() only if `rule_holds` is false.
template <std::invocable Message>
void require_of(std::string_view parameter, bool rule_holds, Message&& message,
                std::source_location where = std::source_location::current()) {
  if (!rule_holds) throw InvalidParameter(parameter, message(), where);
}

}  // namespace softland
