#include "model/structure/structure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <type_traits>

#include "base/require.h"
#include "model/device.h"
#include "model/mode_shapes.h"
#include "model/switch.h"
#include "tests/support/devices.h"

namespace softland {
namespace {

/// Returns the example of a kind over an electrode of its whole length.
template <class Kind>
Device device_of() {
  const Structure s = Kind::template example<Structure>();
  return {.structure = s,
          .gap = {.electrode = 3.5e-6, .contact = 2e-6},
          .electrodes = {{.name = "main", .begin = 0, .end = s.length, .fringing = Fringing::none}},
          .contacts = {Contact{.model = LinearSpring::example(), .pad_length = 5e-6}}};
}

/// The properties that a new kind must have: every test below runs for each kind.
template <class Kind>
class KindOfStructure : public testing::Test {};
using Kinds = testing::Types<Cantilever, Bridge, Plate, ModalStructure>;
static_assert(std::variant_size_v<StructureKind> == 4, "a kind of structure is missing in the list of these tests");
TYPED_TEST_SUITE(KindOfStructure, Kinds);

TYPED_TEST(KindOfStructure, HasAnExampleThatIsASwitch) {
  const Device device = device_of<TypeParam>();
  ASSERT_NO_THROW(validate(device));
  EXPECT_EQ(name_of(device.structure.kind), TypeParam::name);
  const Switch model(device);
  EXPECT_LE(model.modes(), most_modes_of(device.structure));
  EXPECT_TRUE(model.rest().has_value());
}

// The modes are orthonormal in mass. The density of a plate and a beam is uniform, so that the integral of the squared shapes
// is known.
TYPED_TEST(KindOfStructure, HasModesOfUnitMass) {
  constexpr double table_places = 2e-4;  // a table is interpolated by cubics, and its frequencies are rounded
  const Device device = device_of<TypeParam>();
  const Structure& s = device.structure;
  double mass_per_length = 19300 * s.width * s.thickness;
  if (const auto* plate = s.find<Plate>()) mass_per_length = plate->mass / s.length;
  const Switch model(device, {.points_per_length = 96});
  const auto shapes = model.quadrature().shapes().topRows(model.quadrature().points());
  const Eigen::MatrixXd masses =
      mass_per_length * shapes.transpose() * model.quadrature().weights().head(shapes.rows()).matrix().asDiagonal() * shapes;
  EXPECT_LT((masses - Eigen::MatrixXd::Identity(model.modes(), model.modes())).cwiseAbs().maxCoeff(), table_places);
}

TYPED_TEST(KindOfStructure, RefusesNumbersOutsideItsFields) {
  for (const Field<Structure>& field : structure_fields<TypeParam>) {
    if (field.in == nullptr || field.range == Range{}) continue;
    Device device = device_of<TypeParam>();
    field.in(device.structure) = -2;
    try {
      validate(device);
      ADD_FAILURE() << field.key << " = -2 passed";
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("structure." + std::string(field.key)), std::string::npos) << error.what();
    }
  }
}

TYPED_TEST(KindOfStructure, KeepsEveryFieldInAMemberOfItsOwn) {
  Structure s = TypeParam::template example<Structure>();
  std::vector<const void*> members;
  for (const Field<Structure>& field : structure_fields<TypeParam>) {
    if (field.in != nullptr) members.push_back(&field.in(s));
    if (field.count != nullptr) members.push_back(&field.count(s));
    if (field.flag != nullptr) members.push_back(&field.flag(s));
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(members[i], members[k]) << i << " and " << k;
  }
}

TYPED_TEST(KindOfStructure, IsDrawnWithItsOwnModes) {
  const Switch model(device_of<TypeParam>());
  const ModeShapes drawn = mode_shapes(model, 5);
  ASSERT_EQ(drawn.shapes.cols(), model.modes());
  EXPECT_TRUE(drawn.shapes.allFinite());
  EXPECT_GT(drawn.shapes.cwiseAbs().maxCoeff(), 0);
}

TEST(Structure, FindsTheChosenKindAndItsBase) {
  Structure s{.kind = Bridge{{.density = 2330}}};
  ASSERT_NE(s.find<Beam>(), nullptr);
  EXPECT_EQ(s.find<Beam>()->density, 2330);
  EXPECT_EQ(s.find<Cantilever>(), nullptr);
  EXPECT_TRUE(s.has_far_clamp());
  EXPECT_FALSE(s.is_rigid());
  s.kind = Plate{};
  EXPECT_EQ(s.find<Beam>(), nullptr);
  EXPECT_TRUE(s.is_rigid());
  EXPECT_FALSE(s.why_no_layer().empty());
}

}  // namespace
}  // namespace softland
