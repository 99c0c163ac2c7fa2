#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fsm/base/table_reader.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/unit_values.h"

namespace fsm {

/// The summed effects of the active units other than displacing skin.
struct UnitEffects {
  struct Lids {
    float upper_mm = 0, lower_mm = 0, close = 0;
  };
  Sided<Lids> lids;
  float jaw_degrees = 0, jaw_slide_mm = 0, jaw_sway_mm = 0;
  float seal = 0;
  float tongue_raise = 0, tongue_out_mm = 0;
};

/// Regions where expressions crease the skin.
enum class Crease { kForehead, kGlabella, kCrowsFeet, kNasolabial, kNose };
inline constexpr std::size_t kCreases = 5;
/// This many of the first creases may exist at rest, too.
inline constexpr std::size_t kLastingCreases = 4;
/// Depths by Crease, 0..1.
using Creases = std::array<Sided<float>, kCreases>;

// What a unit at full strength does beside displacing skin; each is a kind of row of the table.

struct LidEffect {
  float upper_mm, lower_mm;  ///< the lids' margins go up
};
struct CloseEffect {
  float part;  ///< by which the lids close, 1 = fully
};
struct JawEffect {
  float degrees, slide_mm;
};
struct SwayEffect {
  float mm;  ///< the jaw goes to the side of the unit
};
struct SealEffect {
  float part;  ///< by which the lips are sealed
};
struct TongueEffect {
  float raise, out_mm;
};
struct CreaseEffect {
  std::array<float, kCreases> depth;  ///< by Crease
};
using UnitEffect = std::variant<LidEffect, CloseEffect, JawEffect, SwayEffect, SealEffect,
                                TongueEffect, CreaseEffect>;

/// The table of action units: plain knowledge without vertices.
class UnitTable {
 public:
  struct Field {
    int unit;
    glm::vec2 centre, radius;
    std::optional<Lip> lip;  ///< the lip whose side of the mouth moves; none: both
    glm::vec3 displacement;
  };

  /// Makes a table without units.
  UnitTable() = default;
  /// Throws std::runtime_error naming file and line if the table is damaged, if a number exceeds
  /// what a face can do, or if there are more than kMaxRows.
  explicit UnitTable(const Table& table);
  static constexpr std::size_t kMaxRows = 1000;
  /// Tells whether rows with this key word give a rule, and name a second unit.
  static bool IsRule(std::string_view key);
  /// Adds a row, whose effect adds to those of earlier rows. Throws as the constructor does.
  void Add(const TableRow& row);
  /// Adds the rows of another table, whose asymmetry is ignored.
  void Add(const UnitTable& more);

  /// Gives every unit but those of lids and jaw slightly different strengths on the two sides; the
  /// same `seed` gives the same strengths.
  void MakeAsymmetric(int seed);

  /// Returns the table as text that the constructor can read, one row a line; without asymmetry.
  std::string Text() const;

  const std::vector<Field>& fields() const { return fields_; }
  /// Returns the numbers of the units that have any effect, ascending.
  std::vector<int> Numbers() const;
  /// Returns the strengths that really act: clamped to 0..2, above 1 at half rate (tissue stops
  /// stretching), and corrected for units that act together. A non-finite value becomes 0.
  Sided<UnitValues> ActingUnits(const FaceState& state) const;
  /// Returns the summed effects of acting units but for creases.
  UnitEffects Effects(const Sided<UnitValues>& au) const;
  /// Returns the creases' depths in a state: `at_rest` plus what the acting units add.
  Creases CreaseDepths(const Sided<UnitValues>& au,
                       const std::array<float, kLastingCreases>& at_rest) const;
  /// Returns how far a field, which the table has for the left, moves a vertex on `side`, in mm.
  static glm::vec3 FieldDisplacement(const Field& field, const SkinWeights& weights, Side side);

 private:
  struct Rule {
    enum class Kind { kDamp, kOppose, kStrongest } kind;
    int a, b;
    float share;
  };
  struct Effect {
    int unit;
    UnitEffect effect;
  };
  /// Extra strength per side as a fraction; 0.03 = 3 % stronger.
  Sided<UnitValues> lean_;
  std::vector<Field> fields_;
  std::vector<Rule> rules_;
  std::vector<Effect> effects_;
};

/// Returns the share, 0..1, of units of the agent's left side `x_mm` to the viewer's right of the
/// median: both sides meet within 7 mm of it. The rest is that of the right side.
float LeftShareAt(float x_mm);

}  // namespace fsm
