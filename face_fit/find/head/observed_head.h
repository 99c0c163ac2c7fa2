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

/// A head as the landmark network sees it: it is drawn, the network looks at the picture, and the
/// points it finds are followed back onto the mesh. So what the network is used to get wrong, it
/// gets wrong alike on this head and on a photo.
class ObservedHead {
 public:
  struct Surface {
    std::vector<std::uint32_t> skin_triangles;  ///< of skin, lips and mouth
    bool has_uv_seams = false;                  ///< as for fsm::TransferSurface
    std::vector<bool> is_eye;                   ///< for each vertex, whether it is an eyeball's
  };

  /// A built-in head; the points of its inner lips are moved onto the seam. Error: kBadValue, no
  /// face is seen on it. Throws std::runtime_error if it cannot be drawn.
  static vm::Result<ObservedHead> BuiltIn(FaceNetworks& networks, const std::string& name);
  static vm::Result<ObservedHead> BuiltIn(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                          const std::string& name);
  /// Likewise a head of any maker, whose points stay where the network saw them.
  static vm::Result<ObservedHead> Foreign(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                          const std::string& name, Surface surface);
  /// A head of which `places` are known, as if a network without faults had seen the points there.
  static ObservedHead Exact(std::unique_ptr<fsm::Head> head, const std::string& name,
                            std::vector<MeshPoint> places);

  const std::string& name() const { return name_; }
  const fsm::Head& head() const { return *head_; }
  const fsm::HeadVertices& rest() const { return rest_; }
  const Surface& surface() const { return surface_; }
  /// Where the network's points lie on the head.
  const std::vector<MeshPoint>& places() const { return places_; }
  /// Where it saw them: x, y pixels of `picture`, z millimetres.
  const std::vector<glm::vec3>& detected() const { return detected_; }
  const fsm::Image& picture() const { return picture_; }  ///< what the network was shown
  /// Where its lips meet, if that is seen.
  const std::optional<LipSeam>& seam() const { return seam_; }
  /// The face's own action units, if it has any.
  const std::optional<fsm::UnitTable>& units() const { return units_; }

  /// Where a point of the network lies on the head at rest.
  glm::vec3 AtRest(PointIndex i) const { return places_[i].On(rest_.position); }
  /// Where the network saw a point in `picture`, pixels.
  glm::vec2 DetectedAt(PointIndex i) const { return glm::vec2(detected_[i]); }
  /// From now on moved by these units. Its points stay: they were seen at rest.
  void MoveBy(const fsm::UnitTable& own);

 private:
  ObservedHead(std::unique_ptr<fsm::Head> head, const std::string& name, Surface surface);

  std::string name_;
  std::unique_ptr<fsm::Head> head_;
  Surface surface_;
  fsm::HeadVertices rest_;
  std::vector<MeshPoint> places_;
  std::vector<glm::vec3> detected_;
  fsm::Image picture_;
  std::optional<LipSeam> seam_;
  std::optional<fsm::UnitTable> units_;
};

}  // namespace facefit
