#include "apps/options.h"

#include <CLI/CLI.hpp>

namespace softland::apps {

void Verb::positional(const char* name, std::string& value, const std::string& about, bool required) {
  option(name, value, "", about);
  options_.get_option(name)->required(required);
}

void Verb::more(const char* name, std::vector<std::string>& values, const std::string& about) {
  options_.add_option(name, values, about)->type_name("");
}

void Verb::option(const char* name, std::string& value, const char* word, const std::string& about) {
  options_.add_option(name, value, about)->type_name(word)->check([](const std::string& text) -> std::string {
    if (text.empty()) return "must not be empty";
    // CLI11 takes any next word as the value of an option: refuse the name of another option.
    return text.starts_with("--") ? "a value is missing: " + text + " is an option" : "";
  });
}

void Verb::optional(const char* name, std::optional<std::string>& value, const char* word, const std::string& about) {
  options_
      .add_option_function<std::string>(
          name, [&value](const std::string& text) { value = text; }, about)
      ->type_name(word);
}

void Verb::repeated(const char* name, std::vector<std::string>& values, const char* word, const std::string& about) {
  options_.add_option(name, values, about)->type_name(word)->allow_extra_args(false);
}

void Verb::flag(const char* name, bool& value, const std::string& about) { options_.add_flag(name, value, about); }

void Verb::footer(const std::string& text) { options_.footer(text); }

void Verb::with_scene(const char* word, const char* what, bool required) { positional(word, common_.scene, what, required); }

void Verb::with_set(const std::string& about) { repeated("--set", common_.set, "KEY=VALUE", about + "; may be repeated"); }

void Verb::with_quiet() { flag("--quiet", common_.quiet, "print no progress and no notes on standard error"); }

void Verb::with_json() {
  option("--json", common_.json, "FILE", "write the result as JSON to this file, or - for standard output");
}

void Verb::with_out(const std::string& about) { option("--out", common_.out, "FOLDER", about); }

void Verb::with_out_file(const std::string& about) { option("--out", common_.out, "FILE", about); }

bool Verb::chosen() const { return options_.parsed(); }

}  // namespace softland::apps
