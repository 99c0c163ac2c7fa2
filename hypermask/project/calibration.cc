#include "hypermask/project/calibration.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cassert>
#include <cmath>

#include "hypermask/base/key_lines.h"
#include "vm_protocol/core/text_file.h"

namespace hypermask {
namespace {

constexpr const char* kHeading = "hypermask calibration 1";
constexpr int kLeastSide = 16, kMostSide = 8192;

bool IsSide(double value) {
  return value >= kLeastSide && value <= kMostSide && value == std::floor(value);
}

std::string SideProblem() {
  return fmt::format("expected whole numbers of {} to {} pixels", kLeastSide, kMostSide);
}

template <typename Matrix>
Matrix FromRows(const std::vector<double>& numbers) {
  Matrix matrix;
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    matrix(i / matrix.cols(), i % matrix.cols()) = numbers[static_cast<std::size_t>(i)];
  }
  return matrix;
}

std::string MapProblem(const PlaneMap& map) {
  // Judged without the pixels' sizes in it.
  const double size = map.topLeftCorner<2, 2>().norm();
  const bool inverts = size > 1e-6 && std::abs(map.determinant()) > 1e-9 * size * size;
  return inverts ? "" : "its rows do not make a map that can be reversed";
}

template <typename Matrix>
std::string Rows(const char* key, const Matrix& matrix) {
  std::string line = key;
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    line += fmt::format(" {}", matrix(i / matrix.cols(), i % matrix.cols()));
  }
  return line + "\n";
}

}  // namespace

vm::Result<Calibration> ParseCalibration(const std::string& name, std::string_view text) {
  Calibration read;
  KeyLineFormat format{.heading = kHeading};
  format.keys["camera"] = {
      .numbers = 5, .take = [&](const std::vector<double>& n) -> std::string {
        if (!IsSide(n[0]) || !IsSide(n[1])) return SideProblem();
        const double side = std::max(n[0], n[1]);
        if (!(n[2] >= 0.1 * side && n[2] <= 100 * side)) {
          return "expected a focal length of 0.1 to 100 times the picture's longer side";
        }
        if (!(std::abs(n[3]) <= 2 * n[0] && std::abs(n[4]) <= 2 * n[1])) {
          return "expected a middle within twice the picture's size";
        }
        read.camera = {static_cast<int>(n[0]), static_cast<int>(n[1]), n[2], n[3], n[4]};
        return "";
      }};
  format.keys["projector"] = {.numbers = 2,
                              .take = [&](const std::vector<double>& n) -> std::string {
                                if (!IsSide(n[0]) || !IsSide(n[1])) return SideProblem();
                                read.projector_width = static_cast<int>(n[0]);
                                read.projector_height = static_cast<int>(n[1]);
                                return "";
                              }};
  format.keys["homography"] = {.numbers = 9,
                               .take = [&](const std::vector<double>& n) -> std::string {
                                 read.homography = FromRows<PlaneMap>(n);
                                 return MapProblem(read.homography);
                               }};
  format.keys["affine"] = {.numbers = 6, .take = [&](const std::vector<double>& n) -> std::string {
                             read.affine.topRows<2>() = FromRows<Eigen::Matrix<double, 2, 3>>(n);
                             read.affine.row(2) << 0, 0, 1;
                             return MapProblem(read.affine);
                           }};
  format.keys["space"] = {
      .numbers = 12, .take = [&](const std::vector<double>& n) -> std::string {
        read.space = FromRows<SpaceMap>(n);
        const Eigen::Matrix3d turn = read.space.leftCols<3>();
        if (std::abs(turn.determinant()) > 1e-12 * std::pow(std::max(1e-9, turn.norm()), 3)) {
          return "";
        }
        return "its rows do not make a projector";
      }};
  format.keys["rms"] = {.numbers = 3, .take = [&](const std::vector<double>& n) -> std::string {
                          if (n[0] < 0 || n[1] < 0 || n[2] < 0)
                            return "expected no negative number";
                          read.homography_rms = n[0];
                          read.affine_rms = n[1];
                          read.space_rms = n[2];
                          return "";
                        }};
  format.keys["delay"] = {
      .numbers = 1, .least = 0, .take = [&](const std::vector<double>& n) -> std::string {
        if (n[0] < 0 || n[0] > 1000) return "expected 0 to 1000 ms";
        read.delay_ms = n[0];
        return "";
      }};
  if (auto lines = ReadKeyLines(name, text, format); !lines) return std::unexpected(lines.error());
  return read;
}

vm::Result<Calibration> ReadCalibration(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxKeyLineBytes);
  if (!text) return std::unexpected(text.error());
  return ParseCalibration(path, *text);
}

std::string FormatCalibration(const Calibration& c) {
  std::string text = fmt::format("{}\n", kHeading);
  text += "# Camera: width, height, focal length and the optical axis in the picture, pixels.\n";
  text += fmt::format("camera {} {} {} {} {}\n", c.camera.width, c.camera.height, c.camera.focal,
                      c.camera.centre_x, c.camera.centre_y);
  text += fmt::format("projector {} {}\n", c.projector_width, c.projector_height);
  text += "# From the camera's pixels to the projector's, by rows.\n";
  text += Rows("homography", c.homography);
  text += Rows("affine", Eigen::Matrix<double, 2, 3>(c.affine.topRows<2>()));
  text +=
      "# From mm before the camera (x right, y down, z away) to the projector's pixels, by rows.\n";
  text += Rows("space", c.space);
  text +=
      "# How far the three are from the points they were fitted to, root of mean square, pixels.\n";
  text += fmt::format("rms {:.4g} {:.4g} {:.4g}\n", c.homography_rms, c.affine_rms, c.space_rms);
  if (c.delay_ms)
    text += fmt::format("# ms from camera to projector.\ndelay {:.4g}\n", *c.delay_ms);
  return text;
}

vm::Result<void> WriteCalibration(const Calibration& calibration, const std::string& path) {
  return vm::WriteTextFile(path, FormatCalibration(calibration));
}

std::optional<PlaneMap> MaskToProjector(const Calibration& calibration, Form form,
                                        const MaskLayout& layout, const Points& markers) {
  assert(markers.size() == layout.markers.size());
  switch (form) {
    case Form::kHomography:
      return FitHomography(layout.markers, Apply(calibration.homography, markers));
    case Form::kAffine:
      return FitAffine(layout.markers, Apply(calibration.affine, markers));
    case Form::kSpace:
      break;
  }
  const auto seen = FitHomography(layout.markers, markers);
  if (!seen) return std::nullopt;
  const auto pose = PoseOfPlane(calibration.camera, *seen);
  if (!pose) return std::nullopt;
  Points projected;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    // On the ray of the camera's pixel, at the distance that the mask's pose has there: an error of
    // the pose then moves it little.
    const Eigen::Vector3d placed =
        pose->rotation * Eigen::Vector3d(layout.markers[i].x(), layout.markers[i].y(), 0) +
        pose->position;
    const Eigen::Vector3d ray(
        (markers[i].x() - calibration.camera.centre_x) / calibration.camera.focal,
        (markers[i].y() - calibration.camera.centre_y) / calibration.camera.focal, 1);
    projected.push_back(Apply(calibration.space, placed.z() * ray));
  }
  return FitHomography(layout.markers, projected);
}

}  // namespace hypermask
