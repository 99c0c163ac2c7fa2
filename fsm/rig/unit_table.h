#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "fsm/base/table_reader.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/unit_values.h"

namespace fsm {

/// What the active units do, in sum, beside moving skin.
struct UnitEffects {
  struct Lids {
    float upper_mm = 0, lower_mm = 0, close = 0;
  };
  Sided<Lids> lids;
  float jaw_degrees = 0, jaw_slide_mm = 0, jaw_sway_mm = 0;
  float seal = 0;
  float tongue_raise = 0, tongue_out_mm = 0;
};

/// The table of action units: knowledge only, no vertices. Immutable.
class UnitTable {
 public:
  struct Field {
    int unit;
    glm::vec2 at, radius;
    enum class Lip { kUpper, kLower, kBoth } lip;  ///< whose side of the mouth moves
    glm::vec3 by;
  };

  /// No units at all.
  UnitTable() = default;
  /// Throws std::runtime_error naming file and line if the table is damaged, if a number is beyond
  /// what a face can do, or if there are more than kMostRows.
  explicit UnitTable(const Table& table);
  static constexpr std::size_t kMostRows = 1000;

  /// Gives every unit but those of the lids a slightly different strength on either side, the same
  /// for the same `seed`.
  void MakeAsymmetric(int seed);

  /// The rows of the table, one a line, as the constructor reads them; without asymmetry.
  std::string Text() const;

  const std::vector<Field>& fields() const { return fields_; }
  /// The units that do anything, in ascending order.
  std::vector<int> Numbers() const;
  /// The strengths that really act: clamped to 0..2, above 1 at half rate (tissue stops
  /// stretching), and corrected for units that act together. Not-a-number counts as 0.
  Sided<UnitValues> Combine(const FaceState& state) const;
  UnitEffects Effects(const Sided<UnitValues>& units) const;
  /// The motion of a field, which the table has for the left, at a vertex of either half.
  static glm::vec3 Motion(const Field& field, const SkinWeights& weights, Side side);

 private:
  struct Rule {
    enum class Kind { kDamp, kOppose, kStrongest } kind;
    int a, b;
    float part;
  };
  struct Effect {
    enum class Kind { kLid, kClose, kJaw, kSway, kSeal, kTongue } kind;
    int unit;
    float first, second;
  };
  /// Relative extra strength per side; 0.03 = 3 % stronger.
  Sided<UnitValues> lean_;
  std::vector<Field> fields_;
  std::vector<Rule> rules_;
  std::vector<Effect> effects_;
};

/// Where skin creases with expression.
enum class Crease { kForehead, kGlabella, kCrowsFeet, kNasolabial, kNose };
inline constexpr std::size_t kCreases = 5;
/// The first so many may be there at rest, too.
inline constexpr std::size_t kLastingCreases = 4;
/// How deep each of them is, 0..1.
using Creases = std::array<Sided<float>, kCreases>;
/// The depths in a state: `at_rest` and what the units add to it.
Creases CreaseDepths(const Sided<UnitValues>& units,
                     const std::array<float, kLastingCreases>& at_rest);

}  // namespace fsm
