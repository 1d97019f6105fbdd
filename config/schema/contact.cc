#include "config/schema/laws.h"
#include "config/schema/sections.h"

namespace softland::internal {
namespace {

Contact& contact(Scene& scene, std::size_t) { return *scene.device.contact; }
ContactModel& contact_model(Scene& scene, std::size_t) { return scene.device.contact->model; }
using OfContact = Of<contact>;

std::vector<Key> contact_keys() {
  std::vector<Key> keys = keys_of_laws<ContactModel, contact_model>("law of the contact force");
  const auto of_every_law = {
      OfContact::number<&Contact::pad_length>("pad_length", dimension::length, positive,
                                              "the pad ends at the free end, or lies about the middle between two clamps"),
      OfContact::choice<contact_distributions, &Contact::distribution>(
          "distribution", "where the force acts: at the pad's centre, or wherever the pad is beyond the plane")
          .by_default("'centre'")};
  keys.insert(keys.begin() + 1, of_every_law);
  return keys;
}

void check_pad_length(const Device& d, const SectionReader& in) {
  const bool per_area = acts_per_area(d.contact->model);
  if (!in.is_given("pad_length")) {
    if (d.structure.is_rigid() && !per_area) return;  // only the area of a plate's pad would count
    in.fail(R"(missing key 'pad_length' (a length such as "2 um"))");
  }
  if (per_area) in.require_of_structure("pad_length", "width", d.structure);
  in.require(d.contact->pad_length < d.structure.length, "pad_length", "must be less than " + in.written_length(d.structure));
}

void check_contact(Scene& scene, const SectionReader& in, std::size_t) {
  const Device& d = scene.device;
  const Contact& c = *d.contact;
  check_pad_length(d, in);
  if (std::holds_alternative<RigidStop>(c.model)) {
    in.require(d.structure.is_rigid(), "model", "needs a plate: a beam has modes that take part in an impact");
    in.require(!d.gas || !is_compressible(*d.gas), "model",
               "not with gas.model = \"reynolds\", whose film still flows under a plate that rests");
  }
  check_bounds(c.model, in);
  if (c.distribution == ContactDistribution::pad) {
    const std::string wrong = why_not_along_pad(d.structure, c);
    in.require(wrong.empty(), "distribution", wrong);
  }
}

}  // namespace

Section contact_section() {
  return {.name = "contact",
          .may_vary = true,
          .selector = "model",
          .keys = contact_keys(),
          .about = "contact under the tip; absent: the tip meets nothing",
          .begin =
              [](Scene& scene, const SectionReader& in, std::string_view) {
                scene.device.contact = Contact{.model = law_of<ContactModel>(in)};
                return std::size_t{0};
              },
          .check = check_contact};
}

}  // namespace softland::internal
