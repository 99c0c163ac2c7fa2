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

/// Regions where expressions crease the skin.
enum class Crease { kForehead, kGlabella, kCrowsFeet, kNasolabial, kNose, kForeheadSides };
inline constexpr std::size_t kCreases = 6;
/// This many of the first creases may exist at rest, too; those of the forehead over all of it.
inline constexpr std::size_t kLastingCreases = 4;
/// Depths by Crease, 0..1.
using Creases = std::array<Sided<float>, kCreases>;
constexpr Sided<float>& Of(Creases& creases, Crease which) {
  return creases[static_cast<std::size_t>(which)];
}
constexpr const Sided<float>& Of(const Creases& creases, Crease which) {
  return creases[static_cast<std::size_t>(which)];
}

// What a unit at full strength does beside displacing skin; each is a kind of row of the table.

struct LidEffect {
  float upper_mm, lower_mm;  ///< the lids' margins go up
};
struct CloseEffect {
  float share;  ///< by which the lids close, 1 = fully
};
struct JawEffect {
  float degrees, slide_mm;
};
struct SwayEffect {
  float mm;  ///< the jaw goes to the side of the unit
};
struct SealEffect {
  float share;  ///< by which the lips are sealed
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

  /// How two units correct each other.
  struct Rule {
    enum class Kind { kDamp, kOppose, kStrongest } kind;
    int a, b;
    float share;
  };
  struct Effect {
    int unit;
    UnitEffect effect;
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
  /// Adds the rows of another table.
  void Add(const UnitTable& more);

  /// Returns the table as text that the constructor can read, one row a line.
  std::string Text() const;

  const std::vector<Field>& fields() const { return fields_; }
  const std::vector<Rule>& rules() const { return rules_; }
  const std::vector<Effect>& effects() const { return effects_; }
  /// Returns the numbers of the units that have any effect, ascending.
  std::vector<int> Numbers() const;

 private:
  std::vector<Field> fields_;
  std::vector<Rule> rules_;
  std::vector<Effect> effects_;
};

}  // namespace fsm
