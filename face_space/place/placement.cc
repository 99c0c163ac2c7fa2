#include "face_space/place/placement.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "embedded/network_points.h"
#include "fsm/base/table_reader.h"
#include "vm_protocol/core/lower_case.h"

namespace facespace {
namespace {

constexpr std::size_t kFewestKnown = 4;
constexpr double kReach = 60;  // mm, of a radial basis function

Eigen::Vector3d Vector(glm::vec3 p) { return Eigen::Vector3f(p.x, p.y, p.z).cast<double>(); }

double Near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::exp(-(a - b).squaredNorm() / (kReach * kReach));
}

}  // namespace

vm::Result<KnownPlaces> ReadPlaces(const std::string& name, std::string_view text,
                                   const fsm::Head& head) {
  return fsm::ReadTable(name, text, [&](const fsm::Table& table) {
    KnownPlaces known;
    for (const fsm::TableRow& row : table.rows()) {
      if (row.key() != "place" || (row.size() != 3 && row.size() != 5)) {
        row.Refuse("place MARKER LANDMARK or place MARKER X Y Z expected");
      }
      glm::vec3 at{};
      if (row.size() == 5) {
        for (int k = 0; k < 3; ++k) at[k] = row.Within(static_cast<std::size_t>(k) + 2, -300, 300);
      } else if (const auto found = head.landmarks().find(row.Word(2));
                 found != head.landmarks().end()) {
        at = found->second;
      } else {
        row.Refuse(fmt::format("'{}' is no landmark; fsm --describe prints those there are",
                               row.Word(2).substr(0, 40)));
      }
      if (!known.emplace(row.Word(1), at).second) row.Refuse("a marker that is there twice");
    }
    return known;
  });
}

KnownPlaces PlacesByName(const std::vector<std::string>& markers, const fsm::Head& head) {
  KnownPlaces known;
  const auto add = [&](const std::string& marker, std::string_view landmark) {
    const auto found = head.landmarks().find(landmark);
    if (found != head.landmarks().end()) known.emplace(marker, found->second);
  };
  const fsm::Table points("network_points.txt", embedded::network_points());
  for (const std::string& marker : markers) {
    add(marker, vm::LowerCase(marker));
    for (const fsm::TableRow& row : points.rows()) {
      if (row.Word(1) == marker) add(marker, row.Word(2));
    }
  }
  return known;
}

Eigen::VectorXd Placement::OnHead(const Eigen::Ref<const Eigen::VectorXd>& moves) const {
  Eigen::VectorXd out(moves.size());
  for (Eigen::Index m = 0; m + 2 < moves.size(); m += 3) {
    out.segment<3>(m) = scale * (turn * moves.segment<3>(m));
  }
  return out;
}

std::vector<std::uint32_t> FaceSkin(const fsm::Head& head) {
  const fsm::RigData& rig = head.rig().data();
  const fsm::HeadSurface& topology = head.surface();
  const float chin = head.Landmark("gnathion").y - 6, top = head.Landmark("trichion").y - 4;
  std::vector<bool> chosen(rig.rest.size(), false);
  for (const fsm::HeadSurface::Part& part : topology.parts) {
    if (part.material != fsm::Material::kSkin && part.material != fsm::Material::kLip) continue;
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      const std::uint32_t i = topology.indices[part.first_index + k];
      const glm::vec3 p = rig.rest[i], n = rig.rest_normal[i];
      chosen[i] = rig.bone[i] == fsm::Bone::kSkin && p.z > 25 && n.z > -0.2F && p.y > chin &&
                  p.y < top && std::abs(p.x) < 66 && rig.weights[i].neck > 0.95F;
    }
  }
  for (const fsm::LidRig::Vertex& lid : rig.lids.vertices) {
    if (std::max(lid.point.upper, lid.point.lower) > 0.5F) chosen[lid.vertex] = true;
  }
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i]) vertices.push_back(i);
  }
  return vertices;
}

vm::Result<Placement> PlaceMarkers(const FaceAtRest& rest, const KnownPlaces& known,
                                   const fsm::Head& head) {
  std::vector<Eigen::Index> anchors;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t m = 0; m < rest.markers.size(); ++m) {
    const auto found = known.find(rest.markers[m]);
    if (found == known.end()) continue;
    anchors.push_back(static_cast<Eigen::Index>(m));
    places.push_back(Vector(found->second));
  }
  const auto count = static_cast<Eigen::Index>(anchors.size());
  if (anchors.size() < kFewestKnown) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("of {} markers it is known where they lie on a face, {} or more expected: call "
                    "them as fsm's landmarks (nasion, cheilion_left, ...) or say so in a table "
                    "(--places)",
                    count, kFewestKnown));
  }
  const Eigen::Matrix3Xd from = rest.places(Eigen::all, anchors);
  const Eigen::Matrix3Xd to = Eigen::Matrix3Xd::Map(places.front().data(), 3, count);
  // Umeyama, Least-squares estimation of transformation parameters between two point patterns,
  // 1991.
  const Eigen::Matrix4d similarity = Eigen::umeyama(from, to, true);
  Placement out;
  out.scale = std::cbrt(similarity.topLeftCorner<3, 3>().determinant());
  if (!(out.scale > 1e-3) || out.scale > 1e3) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the markers whose places are known lie on each other or far from a face's "
                    "size; millimetres expected (--mm)");
  }
  out.turn = similarity.topLeftCorner<3, 3>() / out.scale;
  const auto moved = [&similarity](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return similarity.topLeftCorner<3, 3>() * p + similarity.topRightCorner<3, 1>();
  };
  // What the similarity leaves is bent away: sum of w_i near(p, p_i), a little less than an
  // interpolation, for where places are known badly.
  Eigen::MatrixXd nears(count, count), left(count, 3);
  Eigen::Matrix3Xd at(3, count);
  for (Eigen::Index i = 0; i < count; ++i) at.col(i) = moved(from.col(i));
  for (Eigen::Index i = 0; i < count; ++i) {
    left.row(i) = (to.col(i) - at.col(i)).transpose();
    for (Eigen::Index j = 0; j < count; ++j) nears(i, j) = Near(at.col(i), at.col(j));
  }
  nears.diagonal().array() += 1e-3;
  const Eigen::MatrixXd weights = nears.ldlt().solve(left);

  const std::vector<std::uint32_t> skin = FaceSkin(head);
  const std::vector<glm::vec3>& vertices = head.rig().data().rest;
  for (Eigen::Index m = 0; m < rest.places.cols(); ++m) {
    const Eigen::Vector3d here = moved(rest.places.col(m));
    Eigen::Vector3d bent = here;
    for (Eigen::Index i = 0; i < count; ++i) {
      bent += Near(here, at.col(i)) * weights.row(i).transpose();
    }
    std::uint32_t best = skin.front();
    double least = std::numeric_limits<double>::max();
    for (const std::uint32_t i : skin) {
      const double d = (Vector(vertices[i]) - bent).norm();
      if (d >= least) continue;
      least = d;
      best = i;
    }
    out.vertices.push_back(best);
    out.misses_mm.push_back(least);
  }
  return out;
}

}  // namespace facespace
