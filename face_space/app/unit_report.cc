#include "face_space/app/unit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace facespace {
namespace {

/// Of 3 numbers a marker: the farthest any of them goes.
double Farthest(const Eigen::VectorXd& moves) {
  double most = 0;
  for (Eigen::Index m = 0; m + 2 < moves.size(); m += 3)
    most = std::max(most, moves.segment<3>(m).norm());
  return most;
}

std::string UnitName(Eigen::Index vector, bool negative) {
  return fmt::format("Eigen{}{}", vector + 1, negative ? "Minus" : "");
}

bool HasNegative(const EigenUnits& units, Eigen::Index k) {
  return -units.least[k] > 0.1 * std::max(units.most[k], 0.0);
}
bool HasPositive(const EigenUnits& units, Eigen::Index k) {
  return units.most[k] > 0.1 * std::max(-units.least[k], 0.0);
}

}  // namespace

std::string EigenReport(const StillFaces& faces, const EigenUnits& units) {
  Eigen::Index frames = 0;
  for (const FaceMoves& face : faces.faces) frames += face.moves.cols();
  const double samples =
      static_cast<double>(frames) * static_cast<double>(faces.rest.places.cols());
  std::string text = fmt::format(
      "{} recordings, {} frames, {} markers, {} of them still; the face moves by {:.2f} mm (root "
      "mean "
      "square)\n\nFace vectors, of all frames\n  vector   variance   together   mm rms   mm "
      "farthest\n",
      faces.faces.size(), frames, faces.rest.places.cols(), faces.rest.still.size(),
      units.moved_mm);
  double together = 0;
  for (Eigen::Index k = 0; k < units.face.count(); ++k) {
    together += units.face.Share(k);
    const double range = std::max(units.most[k], -units.least[k]);
    text += fmt::format("  {:>6} {:>8.2f} % {:>8.2f} % {:>8.2f} {:>13.2f}\n", k + 1,
                        100 * units.face.Share(k), 100 * together,
                        std::sqrt(units.face.strengths[k] / samples),
                        Farthest(range * units.face.vectors.col(k)));
  }
  text += fmt::format("with them markers lie {:.2f} mm off (root mean square), at most {:.2f}\n\n",
                      units.by_face.rms, units.by_face.worst);
  text += fmt::format("Motion vectors, of {} expressions\n  vector   variance   together\n",
                      units.performances.size());
  together = 0;
  for (Eigen::Index k = 0; k < units.motion.count(); ++k) {
    together += units.motion.Share(k);
    text += fmt::format("  {:>6} {:>8.2f} % {:>8.2f} %\n", k + 1, 100 * units.motion.Share(k),
                        100 * together);
  }
  text += fmt::format(
      "with them expressions made of the face vectors lie {:.2f} mm off, at most {:.2f}\n",
      units.by_motion.rms, units.by_motion.worst);
  return text;
}

std::string TableReport(const Placement& placement, const FaceAtRest& rest,
                        const UnitTables& tables, const std::string& folder) {
  const auto worst = std::ranges::max_element(placement.misses_mm);
  std::string text = fmt::format(
      "\nOn the head: moves times {:.3f}; markers up to {:.1f} mm from its skin ('{}')\n"
      "Units of {}, and how far fsm's face is from them\n  set AU        name                  "
      "rows   mm rms   mm worst\n",
      placement.scale, *worst,
      rest.markers[static_cast<std::size_t>(worst - placement.misses_mm.begin())], folder);
  for (const WrittenUnit& unit : tables.units) {
    std::size_t rows = 0;
    for (const RowFitter::Part& part : unit.parts) rows += part.rows.rows();
    text += fmt::format("  {:<13} {:<20} {:>5} {:>8.2f} {:>10.2f}\n", unit.in_command, unit.name,
                        rows, unit.missing.rms, unit.missing.worst);
  }
  return text + fmt::format("try  fsm --tables {}\n", folder);
}

std::string VectorsCsv(const FaceAtRest& rest, const EigenUnits& units,
                       const std::vector<RecordedUnit>& recorded) {
  std::string text = "vector,variance";
  for (const std::string& marker : rest.markers) text += fmt::format(",{0}_x,{0}_y,{0}_z", marker);
  const auto line = [&text](const std::string& name, const std::string& share,
                            const Eigen::VectorXd& moves) {
    text += "\n" + name + "," + share;
    for (const double number : moves) text += fmt::format(",{:.4f}", number);
  };
  line("rest", "", rest.places.reshaped());
  for (const ShapeUnit& shape : EigenShapes(units)) {
    const auto k = static_cast<Eigen::Index>(std::stol(shape.name.substr(5))) - 1;
    line(shape.name, fmt::format("{:.6f}", units.face.Share(k)), shape.moves);
  }
  for (const RecordedUnit& unit : recorded) line("Recorded" + unit.name, "", unit.moves);
  return text + "\n";
}

std::vector<ShapeUnit> EigenShapes(const EigenUnits& units) {
  std::vector<ShapeUnit> shapes;
  for (Eigen::Index k = 0; k < units.face.count(); ++k) {
    if (HasPositive(units, k))
      shapes.push_back({UnitName(k, false), units.most[k] * units.face.vectors.col(k)});
    if (HasNegative(units, k))
      shapes.push_back({UnitName(k, true), units.least[k] * units.face.vectors.col(k)});
  }
  return shapes;
}

std::map<std::string, std::string> MotionLines(const StillFaces& faces, const EigenUnits& units,
                                               const std::vector<WrittenUnit>& written) {
  std::map<std::string, std::string> files;
  const auto command = [&](const std::string& name) -> const WrittenUnit* {
    const auto found = std::ranges::find(written, name, &WrittenUnit::name);
    return found == written.end() ? nullptr : &*found;
  };
  double length_ms = 0;
  for (const Performance& performance : units.performances) {
    const std::vector<double>& ms = faces.faces[performance.recording].ms;
    length_ms += ms[static_cast<std::size_t>(performance.last)] -
                 ms[static_cast<std::size_t>(performance.first)];
  }
  const double step =
      length_ms / static_cast<double>(units.performances.size()) / (EigenUnits::kCourse - 1);
  for (Eigen::Index e = 0; e < units.motion.count(); ++e) {
    // As large as it is in the expression that has most of it.
    double size = 0;
    for (const Performance& performance : units.performances) {
      const double part = performance.course.reshaped().dot(units.motion.vectors.col(e));
      if (std::abs(part) > std::abs(size)) size = part;
    }
    const Eigen::MatrixXd course = size * units.Motion(e);
    std::string text =
        fmt::format("# Motion vector {}, {:.2f} % of the variance of the expressions\n", e + 1,
                    100 * units.motion.Share(e));
    bool any = false;
    for (Eigen::Index t = 0; t < EigenUnits::kCourse; ++t) {
      std::string line = "set AU =";
      for (Eigen::Index k = 0; k < units.face.count(); ++k) {
        for (const bool negative : {false, true}) {
          const WrittenUnit* unit = command(UnitName(k, negative));
          if (unit == nullptr) continue;
          any = true;
          const double full = negative ? units.least[k] : units.most[k];
          const double strength = std::clamp(course(k, t) / full, 0.0, 1.0);
          std::string words = unit->in_command;  // "801" or "801L 802R"
          if (const std::size_t gap = words.find(' '); gap != words.npos) {
            words.insert(gap, fmt::format(" {:.3f}", strength));
          }
          line += fmt::format(" {} {:.3f}", words, strength);
        }
      }
      text += fmt::format("{} {:.0f}\nset Wait = {:.0f}\n", line, step, step);
    }
    if (any) files.emplace(fmt::format("motion_{}.txt", e + 1), std::move(text));
  }
  return files;
}

}  // namespace facespace
