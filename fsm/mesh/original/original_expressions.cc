#include "fsm/mesh/original/original_expressions.h"

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "fsm/mesh/original/original_points.h"
#include "fsm/mesh/transfer/nnls_solver.h"
#include "fsm/rig/unit_effects.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

/// A residual that moves no vertex by at least this is not shown, millimetres.
constexpr float kMinResidualMm = 0.4f;

/// The name of an expression, with the prefix and the numbers of its patterns' files.
struct Files {
  const char* name;
  const char* stem;
  int first_number, first_pattern, count;
};
constexpr Files kFiles[] = {
    {"HAPPY", "AU", 31, 1, 1},         {"ANGRY", "AU", 32, 1, 1},
    {"DISGUSTED", "AU", 33, 1, 1},     {"SAD", "AU", 34, 1, 1},
    {"SURPRISED", "AU", 35, 1, 1},     {"FEARED", "AU", 36, 1, 1},
    {"HAPPY", "userHap", 2, 2, 4},     {"ANGRY", "userAng", 2, 2, 4},
    {"DISGUSTED", "userDis", 2, 2, 4}, {"SAD", "userSad", 2, 2, 4},
    {"SURPRISED", "userSur", 2, 2, 4}, {"FEARED", "userFea", 2, 2, 4},
    {"USERDEF", "userdef", 1, 1, 5},
};

std::string PathOf(const std::string& folder, const std::string& stem, int number) {
  return folder + "/_AU_Datas/" + stem + (number < 10 ? "0" : "") + std::to_string(number) + ".pnt";
}

class ExpressionReader {
 public:
  ExpressionReader(const std::string& folder, const std::string& path, PntFile standard)
      : folder_(folder), path_(path), standard_(std::move(standard)), space_(standard_) {}

  /// Throws vm::Failure for a file that cannot be read.
  OriginalExpressions Read() {
    ReadUnits();
    for (const Files& files : kFiles) {
      for (int i = 0; i < files.count; ++i) {
        const std::string path = PathOf(folder_, files.stem, files.first_number + i);
        std::error_code none;
        if (!std::filesystem::exists(path, none)) continue;
        OriginalExpression& made = out_.expressions.emplace_back(ReadOne(path));
        made.name = files.name;
        made.pattern = files.first_pattern + i;
      }
    }
    return std::move(out_);
  }

 private:
  /// Returns the offsets of the standard wireframe's points, three numbers each, in millimetres.
  NnlsSolver::Row Offsets(const std::string& path, const PntFile& file) const {
    NnlsSolver::Row row;
    row.reserve(3 * standard_.names.size());
    for (const PointName& name : standard_.names) {
      const auto found = file.index.find(name);
      if (found == file.index.end()) {
        throw vm::Failure(
            {vm::Errc::kBadValue, path + ": " + InWords(name) + " of '" + path_ + "' is missing"});
      }
      const glm::vec3 by = space_.mm() * file.positions[found->second];
      row.insert(row.end(), {by.x, by.y, by.z});
    }
    return row;
  }

  void ReadUnits() {
    const float middle = 0.5f * (space_.PositionMm(standard_, kLipCorners.right).x +
                                 space_.PositionMm(standard_, kLipCorners.left).x);
    std::vector<float> left;
    for (const glm::vec3& p : standard_.positions)
      left.push_back(LeftShareAt(space_.ToMm(p).x - middle));
    std::vector<NnlsSolver::Row> halves;
    for (int unit = 1; unit <= static_cast<int>(kOriginalUnits); ++unit) {
      const std::string path = PathOf(folder_, "AU", unit);
      const NnlsSolver::Row whole = Offsets(path, vm::OrThrow(ReadPnt(path)));
      for (const Side side : kSides) {
        halves.push_back(whole);
        for (std::size_t i = 0; i < halves.back().size(); ++i) {
          halves.back()[i] *= side == Side::kLeft ? left[i / 3] : 1 - left[i / 3];
        }
      }
    }
    units_ = NnlsSolver(std::move(halves));
  }

  /// Reads an expression; its name is not set.
  const OriginalExpression& ReadOne(const std::string& path) {
    std::string text = vm::OrThrow(vm::ReadTextFile(path, kMaxPntBytes));
    // Identical files are read once, since the expressions of users begin as copies of the standard
    // ones.
    if (const auto known = seen_.find(text); known != seen_.end()) return known->second;
    const PntFile file = vm::OrThrow(ParsePnt(path, text));
    return seen_.emplace(std::move(text), Decompose(Offsets(path, file), path)).first->second;
  }

  OriginalExpression Decompose(const NnlsSolver::Row& offsets, const std::string& path) {
    const NnlsSolver::Parts parts = units_.Solve(offsets);
    OriginalExpression made;
    for (std::size_t i = 0; i < kOriginalUnits; ++i) {
      made.strengths.right[i] = parts.weights[2 * i];
      made.strengths.left[i] = parts.weights[2 * i + 1];
    }
    PntFile residual;
    float most = 0;
    for (std::size_t i = 0; i < standard_.names.size(); ++i) {
      const glm::vec3 by(parts.residual[3 * i], parts.residual[3 * i + 1],
                         parts.residual[3 * i + 2]);
      most = std::max(most, glm::length(by));
      residual.index.emplace(standard_.names[i], i);
      residual.positions.push_back(by / space_.mm());
    }
    residual.names = standard_.names;
    if (most < kMinResidualMm) return made;
    if (out_.residuals.size() == Residuals{}.size()) {
      out_.without_residual.push_back(path);
      return made;
    }
    made.residual = out_.residuals.size();
    out_.residuals.push_back(std::move(residual));
    return made;
  }

  const std::string& folder_;
  const std::string& path_;
  const PntFile standard_;
  const OriginalSpace space_;
  NnlsSolver units_;                                // the keys: right and left half of each unit
  std::map<std::string, OriginalExpression> seen_;  // by file content
  OriginalExpressions out_;
};

}  // namespace

vm::Result<OriginalExpressions> ReadOriginalExpressions(const std::string& folder,
                                                        const std::string& standard) try {
  PntFile wireframe = vm::OrThrow(ReadPnt(standard));
  vm::OrThrow(CheckPoints(standard, wireframe));
  return ExpressionReader(folder, standard, std::move(wireframe)).Read();
} catch (const vm::Failure& failure) {
  return std::unexpected(failure.error);
}

}  // namespace fsm
