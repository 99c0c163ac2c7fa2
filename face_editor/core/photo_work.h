#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "face_editor/core/face_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_fit/make_face.h"

namespace editor {

/// The networks and the built-in head as they see it: the same for every photo.
struct FaceModels {
  facefit::FaceNetworks networks;
  std::shared_ptr<const facefit::ObservedHead> base;
  Mirror mirror;
};
/// `folder` as of FaceNetworks::Load; `tables`: a folder whose units, if it has any, move the head
/// that photos are fitted with. Errors: its, and kUnavailable if the head cannot be drawn or the
/// units be read.
vm::Result<std::shared_ptr<FaceModels>> LoadFaceModels(const std::string& folder,
                                                       const std::string& tables);

/// A photo and what was found in it. Immutable; thread: any.
struct PhotoWork {
  std::string path;
  /// Upright, at most facefit::kWorkingSize. Without the networks it is only the photo.
  facefit::PreparedFront front;
  PointMap found;      ///< of the face chosen, or as they may be set by hand
  std::string notice;  ///< what the user should know, a sentence; may be empty
  Mirror mirror;
  // Not there without the networks: then points can be set, but no face be made of them.
  std::shared_ptr<const facefit::ObservedHead> base;
};
/// `models` may be nullptr; `face` counts from 1, the largest. Errors: as facefit::ReadPhoto;
/// kBadValue if there are fewer faces.
vm::Result<std::shared_ptr<const PhotoWork>> OpenPhoto(FaceModels* models, const std::string& path,
                                                       int face);

using SidePhotos = std::vector<std::shared_ptr<const facefit::SidePhoto>>;
/// A photo from the side, if MakeFace would use it for the face that these points make: it shows
/// the same person, turned or in full profile. Takes about a second. Error: kBadValue "PATH: why
/// not". REQUIRES: work.base
vm::Result<std::shared_ptr<const facefit::SidePhoto>> OpenSidePhoto(FaceModels& models,
                                                                    const PhotoWork& work,
                                                                    const PointMap& points,
                                                                    const std::string& path);

/// All 468 points of a face of which some are known. REQUIRES: work.base, eye corners, tip of the
/// nose, mouth corners and chin.
PointMap AllPoints(const PhotoWork& work, const PointMap& known);

/// The head of the person, fitted to points on the photo.
struct BuiltFace {
  std::shared_ptr<const facefit::ObservedHead> base;  ///< the fit refers to it
  facefit::MadeFace made;
  std::shared_ptr<const fsm::Head> head;
};
/// Takes most of a second, and about one more for each photo from the side; for those `models` is
/// looked with, which only one thread may do. Error: kBadValue if the points do not make a face.
/// REQUIRES: work.base; `models`, if there are `sides`.
vm::Result<std::shared_ptr<const BuiltFace>> BuildFace(const PhotoWork& work,
                                                       const PointMap& points,
                                                       FaceModels* models = nullptr,
                                                       const SidePhotos& sides = {});
}  // namespace editor
