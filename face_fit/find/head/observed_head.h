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

/// A head as the landmark network sees it: it is drawn, the network finds points in the picture,
/// and these are projected back onto the mesh. So the network's systematic errors are the same on
/// this head and on a photo.
class ObservedHead {
 public:
  struct Surface {
    std::vector<std::uint32_t> skin_triangles;  ///< skin, lips and mouth
    bool has_uv_seams = false;                  ///< as for fsm::TransferSurface
    std::vector<bool> is_eye;  ///< for each vertex whether it belongs to an eyeball
  };

  /// Observes a built-in head and moves the points of its inner lips onto the seam. Error:
  /// kBadValue, no face is seen on it. Throws std::runtime_error if rendering is impossible.
  static vm::Result<ObservedHead> BuiltIn(FaceNetworks& networks, const std::string& name);
  static vm::Result<ObservedHead> BuiltIn(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                          const std::string& name);
  /// Observes a head of any maker; its points stay where the network saw them. Errors: as BuiltIn.
  static vm::Result<ObservedHead> Foreign(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                          const std::string& name, Surface surface);
  /// Returns a head whose points are known exactly, for comparison. It has no picture and no
  /// surface, and `detected` holds places on the head, millimetres: not for DetectOcclusion.
  static ObservedHead Exact(std::unique_ptr<fsm::Head> head, const std::string& name,
                            std::vector<MeshPoint> places);

  const std::string& name() const { return name_; }
  const fsm::Head& head() const { return *head_; }
  const fsm::HeadVertices& rest() const { return rest_; }
  const Surface& surface() const { return surface_; }
  /// Returns the places of the network's points on the head.
  const std::vector<MeshPoint>& places() const { return places_; }
  /// Returns where the network saw them: x, y pixels of `picture`, z millimetres.
  const std::vector<glm::vec3>& detected() const { return detected_; }
  const fsm::Image& picture() const { return picture_; }  ///< what the network was shown
  /// Returns the line where the lips meet, if it was found.
  const std::optional<LipSeam>& seam() const { return seam_; }
  /// Returns the face's own action units, if it has any.
  const std::optional<fsm::UnitTable>& units() const { return units_; }

  /// Returns the place of a point on the head at rest, millimetres.
  glm::vec3 AtRest(PointIndex i) const { return places_[i].On(rest_.position); }
  /// Returns the pixel of `picture` at which the network saw a point.
  glm::vec2 DetectedAt(PointIndex i) const { return glm::vec2(detected_[i]); }
  /// Replaces the action units. Points stay, since they were observed at rest.
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
