#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "face_space/eigen/eigen_units.h"
#include "fsm/rig/head.h"
#include "fsm/rig/unit_table.h"

namespace facespace {

/// Which sides of the face a unit's rows move.
enum class Acting { kBothSides, kLeftOnly, kRightOnly };

/// A unit as rows of fsm's table of units.
struct UnitRows {
  std::vector<fsm::UnitTable::Field> fields;  ///< `unit` is not set
  double jaw_degrees = 0, jaw_slide_mm = 0;
  double lid_upper_mm = 0, lid_lower_mm = 0;

  std::size_t rows() const {
    return fields.size() + (jaw_degrees != 0 || jaw_slide_mm != 0) +
           (lid_upper_mm != 0 || lid_lower_mm != 0);
  }
  /// The rows of unit `number`, a line each.
  std::string Text(int number) const;
};

/// Writes moves of markers on a built-in head as rows of its table of units. A row's field is a
/// radial function, so the skin between markers follows as the papers' generic model does, by
/// radial basis functions; where and how wide fields lie is chosen one after the other by how much
/// of what is left each explains (orthogonal matching pursuit: Pati, Rezaiifar and Krishnaprasad,
/// 1993). What the jaw and the lids do is found in the same way. Deterministic. Lifetime: the head
/// outlives it. Thread: any.
class RowFitter {
 public:
  /// `vertices`: of the head's skin, one for each marker.
  RowFitter(const fsm::Head& head, std::vector<std::uint32_t> vertices);

  struct Part {
    Acting acting = Acting::kBothSides;
    UnitRows rows;
  };
  /// One part for both sides where that comes about as near as one for each, else two. At most
  /// `most` rows in all.
  std::vector<Part> Fit(const Eigen::Ref<const Eigen::VectorXd>& moves, std::size_t most) const;
  /// How far markers of the head lie elsewhere than `moves` say while it shows the parts at full
  /// strength, with everything that lips, teeth and lids do beside.
  Missing Check(const std::vector<Part>& parts,
                const Eigen::Ref<const Eigen::VectorXd>& moves) const;

 private:
  /// A field before it is known what it moves by: where, and for each marker how much along x and
  /// along the others.
  struct Candidate {
    fsm::UnitTable::Field field;
    Eigen::VectorXd along_x, along_yz;
    Acting acting;
  };
  struct Effect {
    enum class Kind { kJaw, kSlide, kUpperLid, kLowerLid } kind;
    Eigen::VectorXd moves;  ///< of all markers for one of its unit
  };
  struct Problem;
  void AddCandidates(Acting acting);
  Eigen::VectorXd MovesOf(const std::string& table, double amount) const;
  static std::vector<Part> PartsOf(const Problem& problem, bool sides_alike);
  Eigen::VectorXd Shown(const std::vector<Part>& parts) const;  ///< what the head makes of them
  std::vector<Part> Pursue(const Eigen::Ref<const Eigen::VectorXd>& moves, std::size_t most,
                           bool sides_alike) const;

  const fsm::Head& head_;
  std::vector<std::uint32_t> vertices_;
  Eigen::VectorXd rest_;
  std::vector<Candidate> candidates_;
  std::vector<Effect> effects_;
};

}  // namespace facespace
