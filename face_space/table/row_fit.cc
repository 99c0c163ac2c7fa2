#include "face_space/table/row_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <utility>

#include "fsm/base/table_reader.h"
#include "fsm/rig/unit_effects.h"

namespace facespace {
namespace {

using Field = fsm::UnitTable::Field;

constexpr std::array<float, 6> kRadii{8, 11, 15, 20, 27, 36};  // mm
constexpr int kOwnUnit = 900;                                  // of tables that only try something
constexpr double kRidge = 2e-2;
constexpr double kGoodRms = 0.08, kGoodWorst = 0.3;  // mm; no more rows are needed
constexpr double kLeastJaw = 1.5, kLeastSlide = 0.5, kLeastLid = 0.3;
constexpr double kAlikeRms = 0.15;  // mm by which two sides may differ and still count as alike

Eigen::VectorXd PlacesOf(const std::vector<glm::vec3>& position,
                         const std::vector<std::uint32_t>& vertices) {
  Eigen::VectorXd places(3 * static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const glm::vec3 p = position[vertices[k]];
    places.segment<3>(3 * static_cast<Eigen::Index>(k)) =
        Eigen::Vector3f(p.x, p.y, p.z).cast<double>();
  }
  return places;
}

Missing MissOf(const Eigen::VectorXd& missed) {
  Missing out;
  for (Eigen::Index m = 0; m + 2 < missed.size(); m += 3) {
    const double off = missed.segment<3>(m).norm();
    out.rms += off * off;
    out.worst = std::max(out.worst, off);
  }
  out.rms = std::sqrt(3 * out.rms / static_cast<double>(missed.size()));
  return out;
}

float Rounded(double value) { return static_cast<float>(std::round(value * 100) / 100); }

}  // namespace

std::string UnitRows::Text(int number) const {
  std::string text;
  for (const Field& field : fields) {
    const char* const lip = !field.lip                       ? "both"
                            : *field.lip == fsm::Lip::kUpper ? "above"
                                                             : "below";
    text += fmt::format("field {} {:.4g} {:.4g} {:.4g} {:.4g} {} {:.4g} {:.4g} {:.4g}\n", number,
                        field.centre.x, field.centre.y, field.radius.x, field.radius.y, lip,
                        field.displacement.x, field.displacement.y, field.displacement.z);
  }
  if (lid_upper_mm != 0 || lid_lower_mm != 0) {
    text += fmt::format("lid {} {:.3g} {:.3g}\n", number, lid_upper_mm, lid_lower_mm);
  }
  if (jaw_degrees != 0 || jaw_slide_mm != 0) {
    text += fmt::format("jaw {} {:.4g} {:.4g}\n", number, jaw_degrees, jaw_slide_mm);
  }
  return text;
}

/// What a pursuit has chosen so far.
struct RowFitter::Problem {
  std::vector<const Candidate*> fields;
  std::vector<const Effect*> effects;
  Eigen::MatrixXd columns;
  Eigen::VectorXd solution;

  /// Solves for all that is chosen, with a little against fields that only work against each other.
  void Solve(const Eigen::VectorXd& moves) {
    const auto count = static_cast<Eigen::Index>(3 * fields.size() + effects.size());
    columns = Eigen::MatrixXd::Zero(moves.size(), count);
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const auto c = static_cast<Eigen::Index>(3 * f);
      for (Eigen::Index m = 0; m < fields[f]->along_x.size(); ++m) {
        columns(3 * m, c) = fields[f]->along_x[m];
        columns(3 * m + 1, c + 1) = fields[f]->along_yz[m];
        columns(3 * m + 2, c + 2) = fields[f]->along_yz[m];
      }
    }
    for (std::size_t e = 0; e < effects.size(); ++e) {
      columns.col(static_cast<Eigen::Index>(3 * fields.size() + e)) = effects[e]->moves;
    }
    Eigen::MatrixXd products = columns.transpose() * columns;
    products.diagonal().array() += kRidge;
    solution = products.ldlt().solve(columns.transpose() * moves);
  }
  double Amount(std::size_t effect) const {
    return solution[static_cast<Eigen::Index>(3 * fields.size() + effect)];
  }
};

RowFitter::RowFitter(const fsm::Head& head, std::vector<std::uint32_t> vertices)
    : head_(head),
      vertices_(std::move(vertices)),
      rest_(PlacesOf(head.rig().data().rest, vertices_)) {
  for (const Acting acting : {Acting::kBothSides, Acting::kLeftOnly, Acting::kRightOnly}) {
    AddCandidates(acting);
  }
  using enum Effect::Kind;
  effects_.push_back({kJaw, MovesOf("jaw 900 10 0\n", 10)});
  effects_.push_back({kSlide, MovesOf("jaw 900 0 2\n", 2)});
  effects_.push_back({kUpperLid, MovesOf("lid 900 1 0\n", 1)});
  effects_.push_back({kLowerLid, MovesOf("lid 900 0 1\n", 1)});
}

Eigen::VectorXd RowFitter::MovesOf(const std::string& table, double amount) const {
  const auto trial = head_.WithUnits(fsm::UnitTable(fsm::Table("rows", table)));
  fsm::FaceState state;
  state.asymmetry = 0;
  state.au.left[kOwnUnit] = state.au.right[kOwnUnit] = 1;
  fsm::HeadVertices moved;
  trial->Evaluate(state, moved);
  return (PlacesOf(moved.position, vertices_) - rest_) / amount;
}

void RowFitter::AddCandidates(Acting acting) {
  const std::vector<fsm::SkinWeights>& weights = head_.rig().data().weights;
  std::set<std::pair<int, int>> centres;  // mm, rounded: markers of both sides share them
  for (const std::uint32_t v : vertices_) {
    const glm::vec2 domain = weights[v].domain;
    centres.emplace(static_cast<int>(std::lround(std::abs(domain.x))),
                    static_cast<int>(std::lround(domain.y)));
  }
  const glm::vec3 mouth = head_.Landmark("stomion");
  for (const auto& [x, y] : centres) {
    const bool lips = std::abs(static_cast<float>(y) - mouth.y) < 22 && x < 42;
    for (const float radius : kRadii) {
      for (const auto lip : {std::optional<fsm::Lip>{}, {fsm::Lip::kUpper}, {fsm::Lip::kLower}}) {
        if (lip && !lips) continue;
        Candidate candidate;
        candidate.field = {.unit = 0,
                           .centre = {x, y},
                           .radius = {radius, radius},
                           .lip = lip,
                           .displacement = {1, 1, 1}};
        candidate.acting = acting;
        const auto count = static_cast<Eigen::Index>(vertices_.size());
        candidate.along_x = candidate.along_yz = Eigen::VectorXd::Zero(count);
        int reached = 0;
        for (Eigen::Index m = 0; m < count; ++m) {
          glm::vec3 moved(0);
          for (const fsm::Side side : fsm::kSides) {
            if (acting == Acting::kLeftOnly && side != fsm::Side::kLeft) continue;
            if (acting == Acting::kRightOnly && side != fsm::Side::kRight) continue;
            moved += fsm::FieldDisplacement(candidate.field,
                                            weights[vertices_[static_cast<std::size_t>(m)]], side);
          }
          candidate.along_x[m] = static_cast<double>(moved.x);
          candidate.along_yz[m] = static_cast<double>(moved.y);
          reached += moved.y > 0.1F;
        }
        // A field that few markers see says what the skin between them does by chance.
        if (reached >= (acting == Acting::kBothSides ? 4 : 2))
          candidates_.push_back(std::move(candidate));
      }
    }
  }
}

std::vector<RowFitter::Part> RowFitter::Fit(const Eigen::Ref<const Eigen::VectorXd>& moves,
                                            std::size_t most) const {
  std::vector<Part> alike = Pursue(moves, most, true);
  const double rms = Check(alike, moves).rms;
  if (rms < kAlikeRms) return alike;
  std::vector<Part> apart = Pursue(moves, most, false);
  return rms < 1.5 * Check(apart, moves).rms + kAlikeRms ? alike : apart;
}

std::vector<RowFitter::Part> RowFitter::Pursue(const Eigen::Ref<const Eigen::VectorXd>& moves,
                                               std::size_t most, bool sides_alike) const {
  const Eigen::VectorXd wanted = moves;
  std::set<Effect::Kind> refused;
  Problem problem;
  Eigen::VectorXd left = wanted;
  const auto used = [&] { return problem.fields.size() + problem.effects.size(); };
  while (used() < most) {
    const Missing missing = MissOf(left);
    if (missing.rms < kGoodRms && missing.worst < kGoodWorst) break;
    double best = 1e-3;  // square mm: what explains less is no row's worth
    const Candidate* field = nullptr;
    const Effect* effect = nullptr;
    const Eigen::Map<const Eigen::Matrix3Xd> by_axis(left.data(), 3, left.size() / 3);
    for (const Candidate& candidate : candidates_) {
      if ((candidate.acting == Acting::kBothSides) != sides_alike) continue;
      const Eigen::Vector3d dots(by_axis.row(0).dot(candidate.along_x),
                                 by_axis.row(1).dot(candidate.along_yz),
                                 by_axis.row(2).dot(candidate.along_yz));
      const double gain =
          dots[0] * dots[0] / (candidate.along_x.squaredNorm() + kRidge) +
          dots.tail<2>().squaredNorm() / (candidate.along_yz.squaredNorm() + kRidge);
      if (gain > best) {
        best = gain;
        field = &candidate;
      }
    }
    for (const Effect& candidate : effects_) {
      if (refused.contains(candidate.kind)) continue;
      const double dot = left.dot(candidate.moves);
      const double gain = dot * dot / (candidate.moves.squaredNorm() + kRidge);
      if (gain > best) {
        best = gain;
        effect = &candidate;
      }
    }
    if (effect != nullptr) {
      problem.effects.push_back(effect);
      refused.insert(effect->kind);
    } else if (field != nullptr) {
      problem.fields.push_back(field);
    } else {
      break;
    }
    problem.Solve(wanted);
    left = wanted - problem.columns * problem.solution;
  }
  // What jaw and lids would do only a little they do not do: the fields take it over.
  std::vector<const Effect*> kept;
  for (std::size_t e = 0; e < problem.effects.size(); ++e) {
    using enum Effect::Kind;
    const Effect* effect = problem.effects[e];
    const double amount = problem.Amount(e);
    const bool seen = effect->kind == kJaw     ? amount > kLeastJaw
                      : effect->kind == kSlide ? std::abs(amount) > kLeastSlide
                                               : std::abs(amount) > kLeastLid;
    if (seen) kept.push_back(effect);
  }
  problem.effects = kept;
  problem.Solve(wanted);

  // What lips, teeth and lids do beside is not asked for again: that comes nearer at the markers
  // and parts lips that touch.
  return PartsOf(problem, sides_alike);
}

std::vector<RowFitter::Part> RowFitter::PartsOf(const Problem& problem, bool sides_alike) {
  std::vector<Part> parts;
  if (sides_alike) {
    parts.push_back({});
  } else {
    parts.push_back({.acting = Acting::kLeftOnly, .rows = {}});
    parts.push_back({.acting = Acting::kRightOnly, .rows = {}});
  }
  for (std::size_t f = 0; f < problem.fields.size(); ++f) {
    Field field = problem.fields[f]->field;
    const auto c = static_cast<Eigen::Index>(3 * f);
    for (int k = 0; k < 3; ++k)
      field.displacement[k] = std::clamp(Rounded(problem.solution[c + k]), -100.0F, 100.0F);
    if (glm::length(field.displacement) < 0.02F) continue;
    const bool right = problem.fields[f]->acting == Acting::kRightOnly;
    parts[right ? 1 : 0].rows.fields.push_back(field);
  }
  for (std::size_t e = 0; e < problem.effects.size(); ++e) {
    const double amount = problem.Amount(e);
    for (Part& part : parts) {
      // Jaw and lids of a unit with two parts: lids on both sides, the jaw, which is one, by the
      // left.
      const bool first = &part == &parts.front();
      switch (problem.effects[e]->kind) {
        case Effect::Kind::kJaw:
          if (first) part.rows.jaw_degrees = static_cast<double>(Rounded(std::min(amount, 60.0)));
          break;
        case Effect::Kind::kSlide:
          if (first)
            part.rows.jaw_slide_mm = static_cast<double>(Rounded(std::clamp(amount, -30.0, 30.0)));
          break;
        case Effect::Kind::kUpperLid:
          part.rows.lid_upper_mm = static_cast<double>(Rounded(std::clamp(amount, -20.0, 20.0)));
          break;
        case Effect::Kind::kLowerLid:
          part.rows.lid_lower_mm = static_cast<double>(Rounded(std::clamp(amount, -20.0, 20.0)));
          break;
      }
    }
  }
  return parts;
}

Missing RowFitter::Check(const std::vector<Part>& parts,
                         const Eigen::Ref<const Eigen::VectorXd>& moves) const {
  return MissOf(Shown(parts) - moves);
}

Eigen::VectorXd RowFitter::Shown(const std::vector<Part>& parts) const {
  std::string table;
  fsm::FaceState state;
  state.asymmetry = 0;
  std::size_t unit = kOwnUnit;
  for (const Part& part : parts) {
    table += part.rows.Text(static_cast<int>(unit));
    if (part.acting != Acting::kRightOnly) state.au.left[unit] = 1;
    if (part.acting != Acting::kLeftOnly) state.au.right[unit] = 1;
    ++unit;
  }
  const auto head = head_.WithUnits(fsm::UnitTable(fsm::Table("rows", table)));
  fsm::HeadVertices moved;
  head->Evaluate(state, moved);
  return PlacesOf(moved.position, vertices_) - rest_;
}

}  // namespace facespace
