#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "face_fit/find/head/lip_seam.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/find/network/network_points.h"
#include "face_fit/surface/mesh_point.h"
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
  struct Surface {
    std::vector<std::uint32_t> skin_triangles;  ///< of skin, lips and mouth
    bool has_uv_seams = false;                  ///< as for fsm::TransferSurface
    std::vector<bool> is_eye;                   ///< for each vertex, whether it is an eyeball's
  };
  Surface surface = {};
  fsm::HeadVertices rest;
  std::vector<MeshPoint> points;     ///< where the network's points lie on it
  std::vector<glm::vec3> detected;   ///< where it saw them: x, y pixels of `picture`, z millimetres
  fsm::Image picture = {};           ///< what the network was shown
  std::optional<LipSeam> seam = {};  ///< where its lips meet, if that is seen
  std::optional<fsm::UnitTable> units = {};  ///< the face's own action units, if it has any

  /// Where a point of the network lies on the head at rest.
  glm::vec3 AtRest(PointIndex i) const { return points[i].On(rest.position); }
  /// Where the network saw a point in `picture`, pixels.
  glm::vec2 DetectedAt(PointIndex i) const { return glm::vec2(detected[i]); }
  /// From now on moved by these units. Its points stay: they were seen at rest.
  void MoveBy(const fsm::UnitTable& own);

  /// A built-in head; the points of its inner lips are moved onto the seam. Error: kBadValue, no
  /// face is seen on it. Throws std::runtime_error if it cannot be drawn.
  static vm::Result<BaseHead> Observe(FaceNetworks& networks, const std::string& name);
  static vm::Result<BaseHead> Observe(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                      const std::string& name);
  /// Likewise a head of any maker, whose points stay where the network saw them.
  static vm::Result<BaseHead> ObserveForeign(FaceNetworks& networks,
                                             std::unique_ptr<fsm::Head> head,
                                             const std::string& name, Surface surface);
};

}  // namespace facefit
