#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "base/printable.h"
#include "base/read_file.h"
#include "base/require.h"
#include "base/shortened.h"
#include "config/drives.h"
#include "config/invalid_key.h"
#include "config/scene.h"
#include "config/scene_file_impl.h"
#include "config/schema.h"
#include "config/units.h"

namespace softland {
namespace {

using internal::join_path;

/// Returns how many levels of tables are nested in a TOML node; 0 for a value that is not a table.
std::size_t levels(const toml::node& node) {
  const toml::table* table = node.as_table();
  if (!table) return 0;
  std::size_t deepest = 0;
  for (const auto& [key, value] : *table) deepest = std::max(deepest, levels(value));
  return deepest + 1;
}

void record_origins(SceneFile::Impl& impl, const toml::table& table, const std::string& path, std::size_t parts = 1) {
  for (const auto& [key, node] : table) {
    const std::string key_path = join_path(path, key.str());
    const std::string place = fmt::format("{}:{}", impl.name, node.source().begin.line);
    impl.origins[key_path] = {place};
    if (const auto* list = node.as_array()) {
      for (std::size_t k = 0; k < list->size(); ++k) {
        const std::string element = fmt::format("{}[{}]", key_path, k + 1);
        const auto* const one = list->get(k)->as_table();
        if (one == nullptr || parts >= internal::deepest_path) continue;
        impl.origins[element] = {fmt::format("{}:{}", impl.name, one->source().begin.line)};
        record_origins(impl, *one, element, parts + 1);
      }
    }
    const auto* inner = node.as_table();
    if (!inner) continue;
    // The header of a section and a dotted key in the section may each obey the limit while their joint path exceeds it.
    require(parts < internal::deepest_path, fmt::format("{}: a key has more than {} parts", place, internal::deepest_path));
    record_origins(impl, *inner, key_path, parts + 1);
  }
}

bool is_below(std::string_view path, std::string_view ancestor) {
  return path.size() > ancestor.size() && path.starts_with(ancestor) &&
         (path[ancestor.size()] == '.' || path[ancestor.size()] == '[');
}

}  // namespace

const toml::node* SceneFile::Impl::find(const std::vector<std::string>& path) const {
  const toml::node* node = &root;
  for (const std::string& key : path) {
    const toml::table* table = node->as_table();
    node = table ? internal::child_of(*table, key) : nullptr;
    if (!node) return nullptr;
  }
  return node;
}

SceneFile::Impl::Origin SceneFile::Impl::origin(std::string_view path) const {
  if (const auto exact = origins.find(path); exact != origins.end()) return exact->second;
  // A key without a recorded origin (file and line, or option) has the origin of the innermost value that contains the key, for
  // example the option that set its whole section.
  const Origin* nearest = nullptr;
  for (const auto& [known, place] : origins) {
    if (is_below(path, known)) nearest = &place;  // the paths are sorted, so the last match is the innermost value
  }
  if (nearest) return *nearest;
  // A section that exists only because an option set one of its keys has that option as its origin.
  for (const auto& [known, place] : origins) {
    if (is_below(known, path)) return place;
  }
  return {name};
}

void SceneFile::Impl::forget(std::string_view path) {
  std::erase_if(origins, [&](const auto& entry) { return entry.first == path || is_below(entry.first, path); });
}

std::string SceneFile::Impl::written(std::string_view path) const {
  const toml::node* node = find(internal::split_path(path));
  return fmt::format("{} = {}", shortened(path), shortened(node ? internal::inline_text(*node) : std::string()));
}

namespace {

// Splits the origin of a key, "scenes/x.toml:12", into file and line.
InvalidKey::Place place_of_origin(std::string_view key, const SceneFile::Impl::Origin& origin) {
  InvalidKey::Place place{.key = std::string(key)};
  if (origin.is_option) return place;
  const std::size_t colon = origin.text.rfind(':');
  const auto line = colon == std::string::npos ? std::string() : origin.text.substr(colon + 1);
  const bool is_line = !line.empty() && line.size() < 9 && line.find_first_not_of("0123456789") == std::string::npos;
  place.file = is_line ? origin.text.substr(0, colon) : origin.text;
  place.line = is_line ? std::stoi(line) : 0;
  return place;
}

}  // namespace

void SceneFile::Impl::fail(std::string_view path, std::string_view rule) const {
  const Origin place = origin(path);
  const auto exact = origins.find(path);
  const bool is_said = place.is_option && exact != origins.end();
  throw InvalidKey(is_said ? fmt::format("{}: {}", place.text, printable_line(rule))
                           : fmt::format("{}: {}: {}", place.text, written(path), printable_line(rule)),
                   place_of_origin(path, place));
}

void SceneFile::Impl::fail_section(std::string_view path, std::string_view rule) const {
  const auto is_option_below = [&](const auto& entry) { return entry.second.is_option && is_below(entry.first, path); };
  const auto option = std::find_if(origins.begin(), origins.end(), is_option_below);
  const Origin place = option == origins.end() ? origin(path) : option->second;
  throw InvalidKey(fmt::format("{}: [{}]: {}", place.text, shortened(path), printable_line(rule)), place_of_origin(path, place));
}

void SceneFile::Impl::insert(const std::vector<std::string>& path, const toml::node& value, const Origin& place) {
  toml::table* table = &root;
  std::string parent, path_text, replaced;
  for (const std::string& key : path) {
    parent = std::exchange(path_text, join_path(path_text, key));
    if (&key == &path.back()) break;
    toml::node* const known = const_cast<toml::node*>(internal::child_of(*table, key));
    if (known == nullptr) {
      if (internal::without_element(key).second)
        throw InvalidInput(fmt::format("{}: {} is not an element of a list in this scene", place.text, path_text));
      table->insert(key, toml::table{});
    }
    table = (known != nullptr ? known : table->get(key))->as_table();
    if (!table) throw InvalidInput(fmt::format("{}: {} is not a section", place.text, written(path_text)));
  }
  if (const internal::Section* section = internal::find_section(path.front(), path.size() > 1 ? path[1] : std::string());
      section && (path.size() == (section->is_named ? 3U : 2U) || (section->may_be_named && path.size() == 3))) {
    for (const internal::Key& key : section->keys) {
      if (key.name != path.back()) continue;
      for (const std::string_view other : key.instead_of) {
        if (table->erase(other) == 0) continue;
        replaced = join_path(parent, other);
        forget(replaced);
      }
    }
  }
  value.visit([&](const auto& node) { table->insert_or_assign(path.back(), node); });
  forget(path_text);
  origins[path_text] = place;
  origins[path_text].replaced = replaced;
}

std::string SceneFile::Impl::replaced_in(std::string_view section) const {
  for (const auto& [path, place] : origins) {
    if (!place.replaced.empty() && is_below(path, section)) return fmt::format("; {} replaced {}", path, place.replaced);
  }
  return {};
}

toml::array SceneFile::Impl::with_element(const std::vector<std::string>& path, std::size_t element, const toml::node& value,
                                          const std::string& option) const {
  const toml::node* there = find(path);
  const toml::array* list = there == nullptr ? nullptr : there->as_array();
  require(list != nullptr, [&] {
    return fmt::format("{}: {} must be a list in this scene: give the whole list, such as --set '{}=[\"10 um\", \"tip\"]'",
                       option, fmt::join(path, "."), fmt::join(path, "."));
  });
  require(element >= 1 && element <= list->size(),
          [&] { return fmt::format("{}: {} is a list of {}, counted from 1", option, fmt::join(path, "."), list->size()); });
  toml::array changed = *list;
  value.visit([&](const auto& node) { changed.replace(changed.cbegin() + static_cast<std::ptrdiff_t>(element - 1), node); });
  return changed;
}

bool SceneFile::Impl::is_named(const internal::Section& section) const {
  if (!section.may_be_named) return section.is_named;
  const toml::node* node = find({std::string(section.name)});
  return node != nullptr && node->is_table() &&
         std::ranges::any_of(*node->as_table(), [](const auto& entry) { return entry.second.is_table(); });
}

std::vector<std::string> SceneFile::Impl::names_in(const std::string& section) const {
  std::vector<std::string> names;
  const toml::node* node = find({section});
  if (!node) return names;
  if (!node->is_table()) fail(section, fmt::format("expected sections [{}.NAME]", section));
  const std::string_view beside = internal::find_section(section)->beside;
  for (const auto& [key, value] : *node->as_table()) {
    if (!beside.empty() && key.str() == beside) continue;
    if (!value.is_table()) {
      const std::string key_beside = beside.empty() ? "" : fmt::format(" or the key '{}'", beside);
      if (internal::find_section(section)->may_be_named)
        fail(join_path(section, key.str()),
             fmt::format("[{}] must not be combined with [{}.NAME]: use one of the two forms", section, section));
      fail(join_path(section, key.str()), fmt::format("expected a section [{}.NAME]{}", section, key_beside));
    }
    names.emplace_back(key.str());
  }
  return names;
}

SceneFile::SceneFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneFile::SceneFile(const SceneFile& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
SceneFile& SceneFile::operator=(const SceneFile& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
SceneFile::SceneFile(SceneFile&&) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&&) noexcept = default;
SceneFile::~SceneFile() = default;

SceneFile SceneFile::load(const std::filesystem::path& path) { return parse(read_file(path), path.string(), path.parent_path()); }

SceneFile SceneFile::parse(std::string_view text, std::string name, std::filesystem::path directory) {
  auto impl = std::make_unique<Impl>();
  impl->root = internal::parse_toml(text, name);
  impl->name = std::move(name);
  impl->directory = std::move(directory);
  record_origins(*impl, impl->root, "");
  return SceneFile(std::move(impl));
}

void SceneFile::set(std::string_view assignment) {
  const std::string option = "--set " + shortened(printable_line(assignment));
  const auto equals = assignment.find('=');
  require(equals != std::string_view::npos, option + ": must be of the form key.path=value");
  const std::string_view value = assignment.substr(equals + 1);

  const auto [key, element] = internal::without_element(assignment.substr(0, equals));
  std::vector<std::string> path;
  try {
    path = internal::split_path(key);
  } catch (const InvalidInput& error) {
    throw InvalidInput(option + ": " + error.what());
  }

  toml::table parsed;
  try {
    parsed = internal::parse_value(value);
  } catch (const InvalidInput&) {
    parsed.clear();
  }
  if (parsed.size() != 1) {  // not a single TOML value (a line break may begin a second key): read the text as a string
    try {
      parsed = internal::parse_value(internal::toml_string(value));
    } catch (const InvalidInput&) {
      throw InvalidInput(
          fmt::format("--set {}: the value is not UTF-8 text", shortened(printable_line(assignment.substr(0, equals)))));
    }
  }

  const toml::node& node = *parsed.get(internal::value_key);
  require(path.size() + levels(node) <= internal::deepest_path,
          [&] { return fmt::format("{}: a key has more than {} parts", option, internal::deepest_path); });
  if (element) {
    impl_->insert(path, impl_->with_element(path, *element, node, option), {option, true});
  } else {
    impl_->insert(path, node, {option, true});
  }
}

void SceneFile::assign(const std::string& path, const SceneValue& value) {
  const std::vector<std::string> parts = internal::split_path(path);
  const internal::Key* key = internal::find_key(parts);
  if (key == nullptr) throw std::logic_error("no scene has the key " + path);
  toml::table holder;
  std::visit(
      [&]<class Value>(const Value& v) {
        if constexpr (std::is_same_v<Value, double>) {
          if (!key->is_bare_number()) return void(holder.insert(internal::value_key, quantity_text(v, key->dimensions.front())));
        }
        holder.insert(internal::value_key, v);
      },
      value);
  impl_->insert(parts, *holder.get(internal::value_key), {impl_->name});
}

void SceneFile::assign(const std::string& path, const Quantity& value, std::size_t element) {
  const std::vector<std::string> parts = internal::split_path(path);
  const internal::Key* key = internal::find_key(parts);
  if (key == nullptr) throw std::logic_error("no scene has the key " + path);
  toml::table holder;
  internal::insert_quantity(*key, value, [&](const auto& node) { holder.insert(internal::value_key, node); });
  if (element == 0) return impl_->insert(parts, *holder.get(internal::value_key), {impl_->name});
  const toml::node* there = impl_->find(parts);
  if (there == nullptr || !there->is_array() || element > there->as_array()->size())
    throw std::logic_error(fmt::format("{} has no element {}", path, element));
  toml::array list = *there->as_array();
  holder.get(internal::value_key)->visit([&](const auto& node) {
    list.replace(list.cbegin() + static_cast<std::ptrdiff_t>(element - 1), node);
  });
  impl_->insert(parts, list, {impl_->name});
}

void SceneFile::erase(const std::string& path) {
  const std::vector<std::string> parts = internal::split_path(path);
  toml::table* table = &impl_->root;
  for (std::size_t i = 0; i + 1 < parts.size() && table; ++i) {
    toml::node* const inner = const_cast<toml::node*>(internal::child_of(*table, parts[i]));
    table = inner != nullptr ? inner->as_table() : nullptr;
  }
  if (table && table->erase(parts.back()) > 0) impl_->forget(path);
}

void SceneFile::set_waveform(const std::string& drive, const Waveform& given) {
  if (const Own* own = std::get_if<Own>(&given))
    throw InvalidInput(fmt::format("waveform.{}: {} cannot be written into a scene file", drive, described(*own)));
  static_cast<void>(signal(given));  // throw for invalid parameters, which read_scene() would refuse in the written scene
  const bool is_factor = drive == dispersion_drive;
  const Waveform waveform = is_factor ? internal::raised(given, 1) : given;
  toml::table table{{"family", std::string(family(waveform))}};
  std::visit(
      [&]<class Family>(const Family& w) {
        for (const Parameter<Family>& p : FamilyOf<Family>::parameters) {
          const bool plain = is_factor && (p.kind == ParameterKind::level || p.kind == ParameterKind::swing);
          const auto put = [&](auto&& insert, double value) {
            plain ? insert(value) : insert(quantity_text(value, internal::dimension_of(p.kind)));
          };
          if (const auto* one = std::get_if<double Family::*>(&p.member)) {
            if (std::isfinite(w.*(*one))) put([&](const auto& value) { table.insert(p.name, value); }, w.*(*one));
            continue;
          }
          toml::array array;
          for (const double v : w.*std::get<std::vector<double> Family::*>(p.member)) {
            put([&](const auto& value) { array.push_back(value); }, v);
          }
          table.insert(p.name, std::move(array));
        }
      },
      waveform);
  for (const std::string_view key : {internal::before_key, internal::before_state_key}) {
    if (const toml::node* before = impl_->find({"waveform", drive, std::string(key)}))
      before->visit([&](const auto& node) { table.insert(key, node); });
  }
  toml::table* waveforms = impl_->root["waveform"].as_table();
  if (!waveforms) waveforms = impl_->root.insert_or_assign("waveform", toml::table{}).first->second.as_table();
  waveforms->insert_or_assign(drive, std::move(table));
  const std::string path = join_path("waveform", drive);
  impl_->forget(path);
  impl_->origins[path] = {impl_->name};
}

void SceneFile::forget_places() { impl_->origins.clear(); }

void SceneFile::add_contact(const Contact& contact) { impl_->own_contact = contact; }

SceneFile SceneFile::again(std::string name) const {
  SceneFile same = parse(internal::write_scene(impl_->root), std::move(name));
  same.impl_->own_contact = impl_->own_contact;
  return same;
}

namespace {

// Throws InvalidInput for a scene that contains more than a file can express, such as an added contact.
void require_writable(const SceneFile::Impl& impl) {
  const auto* const own = impl.own_contact ? std::get_if<OwnContact>(&impl.own_contact->model) : nullptr;
  require(!impl.own_contact, [&] {
    return fmt::format("{}: the contact law '{}' is defined by a program, and a scene file cannot express it", impl.name,
                       own && own->own ? own->own->name() : name_of(impl.own_contact->model));
  });
}

}  // namespace

std::string SceneFile::text() const {
  require_writable(*impl_);
  return internal::write_scene(impl_->root);
}
nlohmann::json SceneFile::json() const {
  require_writable(*impl_);
  return internal::to_json(impl_->root);
}

std::optional<std::string> SceneFile::written(const std::string& path) const {
  const toml::node* node = impl_->find(internal::split_path(path));
  if (node == nullptr) return std::nullopt;
  if (const auto* section = node->as_table()) return (*section)["model"].value_or(std::string());
  if (const auto* text = node->as_string()) return text->get();
  return internal::to_json(*node).dump();
}

std::vector<std::string> SceneFile::keys(const std::string& section) const {
  std::vector<std::string> all;
  const toml::node* node = impl_->find(internal::split_path(section));
  if (node == nullptr || !node->is_table()) return all;
  for (const auto& [key, value] : *node->as_table()) all.emplace_back(key.str());
  return all;
}

const std::string& SceneFile::name() const { return impl_->name; }

void SceneFile::refuse(const std::string& path, std::string_view rule) const {
  std::vector<std::string> parts = internal::split_path(path);
  if (impl_->find(parts)) impl_->fail(path, rule);
  parts.pop_back();
  std::string section;
  for (const std::string& part : parts) section = join_path(section, part);
  impl_->fail_section(section, rule);
}

}  // namespace softland
