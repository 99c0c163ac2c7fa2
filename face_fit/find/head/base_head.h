#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "face_fit/find/head/mesh_point.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/find/network/network_points.h"
#include "fsm/rig/head.h"
#include "fsm/rig/unit_table.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// A built-in head as the landmark network sees it: it is drawn, the network looks at the picture,
/// and the points it finds are followed back onto the mesh. So what the network is used to get
/// wrong, it gets wrong alike on this head and on a photo.
struct BaseHead {
  std::string name;
  std::unique_ptr<fsm::Head> head;
  fsm::HeadVertices rest;
  std::vector<MeshPoint> points;             ///< where the network's points lie on it
  std::vector<float> seen_z;                 ///< the depth the network gave each, millimetres
  fsm::Image picture = {};                   ///< what the network was shown
  std::vector<glm::vec2> seen = {};          ///< where it found the points there, pixels
  std::optional<fsm::UnitTable> units = {};  ///< of one's own, that move it

  /// Where a point of the network lies on the head at rest.
  glm::vec3 AtRest(PointIndex i) const { return points[i].On(rest.position); }
  /// From now on moved by these units. Its points stay: they were seen at rest.
  void MoveBy(const fsm::UnitTable& own);

  /// Error: kBadValue, no face is seen on it. Throws std::runtime_error if it cannot be drawn.
  static vm::Result<BaseHead> See(FaceNetworks& networks, const std::string& name);
  /// Likewise of any head. `own_seam`: its lips meet in a seam that its own units open, onto which
  /// the points of the inner lips are moved.
  static vm::Result<BaseHead> See(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                  const std::string& name, bool own_seam);
};

}  // namespace facefit
