#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/engineering.h"
#include "config/schema/sections.h"
#include "config/section_reader.h"

namespace softland::internal {
namespace {

MetricsOptions& metrics_options(Scene& scene, std::size_t) { return scene.metrics; }
using OfMetrics = Of<metrics_options>;

ElectricalClosing& electrical(Scene& scene, std::size_t) { return scene.device.electrical; }
using OfElectrical = Of<electrical>;

Key connection_key() {
  Key key{.name = "closed",
          .type = KeyType::texts,
          .about =
              "contacts that must be closed for the connection: \"all\" (default), \"any\", "
              "or a list of contacts that must all be closed"};
  for (const auto& row : connections) key.words.push_back(row.name);
  return key;
}

// Sets the contacts that make the electrical connection, and whether the connection needs all of them.
void set_connection(Device& d, const SectionReader& in) {
  if (!in.is_given("closed")) return;
  const bool is_list = in.is_list("closed");
  in.require(d.contacts.size() > 1, "closed",
             "needs several contacts [contact.NAME], of which it names those that make the connection");
  const std::vector<std::string>& given = in.texts("closed");
  if (!is_list) {
    d.connection = find_named(connections, given.front())->value;
    return;
  }
  in.require(!given.empty(), "closed", "needs a contact, \"all\" or \"any\"");
  for (const std::string& name : given) {
    const auto named = std::ranges::find(d.contacts, name, &Contact::name);
    std::vector<std::string_view> known;
    for (const Contact& c : d.contacts) known.push_back(c.name);
    in.require(named != d.contacts.end(), "closed", "unknown contact [contact." + name + "]" + hint(name, known));
    in.require(named->side == Side::near, "closed", "[contact." + name + "] is a back stop: it makes no connection");
  }
  for (Contact& c : d.contacts) c.connects = std::ranges::find(given, c.name) != given.end();
}

// Sorts the contacts independently of their order in the file; the static figures are those of the first contact. Contacts that
// make the connection come first, back stops last; within these groups, contacts are sorted from the tip, then by their gap.
void order_contacts(Device& d) {
  if (d.contacts.size() < 2) return;
  d.contacts.front().gap = d.gap.contact;
  const auto rank = [&](const Contact& c) {
    const double place = d.contact_position(static_cast<std::size_t>(&c - d.contacts.data()));
    return std::tuple(!c.connects, c.side == Side::far, -place, c.gap, c.name);
  };
  std::vector<std::pair<decltype(rank(d.contacts.front())), Contact>> ranked;
  for (const Contact& c : d.contacts) ranked.emplace_back(rank(c), c);
  std::ranges::sort(ranked, {}, [](const auto& one) { return one.first; });
  for (std::size_t k = 0; k < ranked.size(); ++k) d.contacts[k] = ranked[k].second;
  d.gap.contact = d.contacts.front().gap;
}

// Checks the keys that define when the electrical connection counts as closed. They need a contact; closed_resistance needs the
// resistivity of every contact that makes the connection.
void check_electrical(const Device& d, const SectionReader& in) {
  for (const std::string_view key : {"closed_force", "closed_resistance", "closed_after"}) {
    in.require(!in.is_given(key) || d.has_contact(), key, "needs a [contact]");
  }
  if (!in.is_given("closed_resistance")) return;
  for (const Contact& c : d.contacts) {
    in.require(!c.connects || c.conduction.is_given(), "closed_resistance",
               "needs contact" + (c.name.empty() ? "" : "." + c.name) + ".resistivity");
  }
}

void check_metrics(Scene& scene, const SectionReader& in, std::size_t) {
  set_face_contact(scene.device);
  set_connection(scene.device, in);
  order_contacts(scene.device);
  check_electrical(scene.device, in);
  scene.metrics.asked = asked_figures(scene.device);
  const double rebound = scene.metrics.significant_rebound;
  if (rebound < scene.device.gap.contact) return;
  const bool named = in.file().is_named(*find_section("contact"));
  const SectionReader gap(in.file(), named ? "contact" : "gap", named ? scene.device.contacts.front().name : std::string());
  const std::string_view key = named ? "gap" : "contact";
  in.require(!in.is_given("significant_rebound"), "significant_rebound", "must be less than " + gap.written(key));
  gap.require(false, key, "must exceed metrics.significant_rebound, which is " + engineering(rebound, "m"));
}

}  // namespace

Section metrics_section() {
  return {
      .name = "metrics",
      .always_in_force = true,
      .keys = {OfMetrics::number<&MetricsOptions::significant_rebound>(
                   "significant_rebound", dimension::length, positive,
                   "rebounds up to this height are not significant; less than gap.contact")
                   .by_default("'1 nm'"),
               OfMetrics::number<&MetricsOptions::steady_force>(
                   "steady_force", dimension::none, {.least = 0, .most = 1, .least_open = true, .most_open = true},
                   "share of the hold force above which the contact force is steady; default 10 %")
                   .such_as("10 %"),
               connection_key(),
               OfElectrical::number<&ElectricalClosing::force>(
                   "closed_force", dimension::force, not_negative,
                   "the connection counts as closed while its contact force is above this; absent: at any force"),
               OfElectrical::number<&ElectricalClosing::resistance>(
                   "closed_resistance", dimension::resistance, positive,
                   "the connection counts as closed while its resistance is below this; "
                   "needs resistivity of its contacts; absent: at any resistance")
                   .such_as("1 ohm"),
               OfElectrical::number<&ElectricalClosing::after>("closed_after", dimension::time, not_negative,
                                                               "openings of the connection up to this duration are not counted; "
                                                               "given alone, closed is what is in touch; default 0")
                   .such_as("1 us")},
      .about = "figures of merit",
      .begin = [](Scene&, const SectionReader&, std::string_view) { return std::size_t{0}; },
      .check = check_metrics};
}

}  // namespace softland::internal
