#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hypermask/base/mask_layout.h"
#include "hypermask/geometry/pinhole.h"
#include "vm_protocol/core/result.h"

namespace hypermask {

/// How a point in the camera's picture is brought to the projector's.
enum class Form {
  kHomography,  ///< by one homography: right on one plane, near it elsewhere
  kAffine,      ///< by one affine map, as the papers' system did in the end
  kSpace,       ///< by where the mask stands in space: right at every distance
};

/// What is known of a camera and a projector that stand fast: how one's picture lies in the
/// other's, in all three forms.
struct Calibration {
  Pinhole camera{};  ///< its picture's size, and its focal length as it was given
  int projector_width = 0, projector_height = 0;
  PlaneMap homography = PlaneMap::Identity();  ///< camera's pixels to projector's
  PlaneMap affine = PlaneMap::Identity();      ///< the same, last row 0 0 1
  SpaceMap space = SpaceMap::Zero();           ///< mm before the camera to the projector's pixels
  /// Root of mean squared distance, projector's pixels, of the points each was fitted to.
  double homography_rms = 0, affine_rms = 0, space_rms = 0;
  std::optional<double> delay_ms{};  ///< of the chain, if it was measured
};

/// A file of it: docs/hypermask.md, "The calibration's file". Errors: those of vm::ReadTextFile and
/// vm::WriteTextFile; kBadValue as ReadKeyLines.
vm::Result<Calibration> ReadCalibration(const std::string& path);
vm::Result<Calibration> ParseCalibration(const std::string& name, std::string_view text);
std::string FormatCalibration(const Calibration& calibration);
vm::Result<void> WriteCalibration(const Calibration& calibration, const std::string& path);

/// How the mask's plane (mm) lies in the projector's picture when the camera sees its markers at
/// `markers`. kAffine: the markers too are taken for an affine view of the mask. Nothing if they
/// are not such a view. REQUIRES: as many markers as in the layout.
std::optional<PlaneMap> MaskToProjector(const Calibration& calibration, Form form,
                                        const MaskLayout& layout, const Points& markers);

}  // namespace hypermask
