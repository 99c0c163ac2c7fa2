#include "face_fit/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "face_fit/find/face/cut_off.h"
#include "face_fit/find/face/joined_names.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns the mean difference of neighbouring pixels in the face, divided by its brightness.
float Sharpness(const FoundFace& face, const fsm::Image& photo) {
  constexpr int kSamples = 60;         // on a side of the middle half of the face
  constexpr float kStep = 1 / 150.0F;  // relative to the face's size: finer than any feature
  float sum = 0, total = 0;
  const float step = std::max(kStep * face.crop.size, 1.0F);
  for (int y = 0; y < kSamples; ++y) {
    for (int x = 0; x < kSamples; ++x) {
      const glm::vec2 p = face.crop.ToImage(0.25F + 0.5F * glm::vec2(x, y) / float{kSamples});
      const float brightness = Brightness(ColourAt(photo, p));
      sum += std::abs(brightness - Brightness(ColourAt(photo, p + glm::vec2(step, 0))));
      total += brightness;
    }
  }
  return sum / std::max(total, 1.0F);
}

/// Returns the brightness of the person's left cheek divided by the right one's.
float SideLight(const FoundFace& face, const fsm::Image& photo) {
  fsm::Sided<float> brightness{1, 1};
  for (const fsm::Side side : fsm::kSides) {
    for (const PointIndex i : point::kCheeks[side]) {
      brightness[side] += Brightness(ColourAt(photo, face.PixelOf(i)));
    }
  }
  return brightness.left / brightness.right;
}

/// The warnings of a report, a line each.
class Warnings {
 public:
  void Add(bool applies, const std::string& text) {
    if (applies) lines_ += "warning: " + text + "\n";
  }
  const std::string& lines() const { return lines_; }

 private:
  std::string lines_;
};

void WarnOfPose(const CameraPose& pose, Warnings& warnings) {
  const auto& look = PhotoLook().report;
  const float turned_deg = std::abs(glm::degrees(pose.rotation_rad.y));
  const float bent_deg = std::abs(glm::degrees(pose.rotation_rad.x));
  warnings.Add(turned_deg > look.turned_far_deg,
               fmt::format("the head is turned far; its other side is guessed and may look wrong: "
                           "a photo turned by less than {} degrees is needed, or --view with "
                           "another one",
                           look.turned_deg));
  warnings.Add(turned_deg > look.turned_deg && turned_deg <= look.turned_far_deg,
               "the head is turned; one side is completed from the other");
  warnings.Add(bent_deg > look.bent_deg, "the head is bent; a level photo fits better");
}

void WarnOfEyes(const PhotoIrises& irises, Warnings& warnings) {
  const auto hidden = std::ranges::count(irises.eyes.InOrder(), false, &PhotoIris::seen);
  warnings.Add(hidden == 2,
               "no iris is seen: the eyes are shut, look down or lie in the shade; they are drawn, "
               "and their lids keep what the photo shows on them");
  warnings.Add(hidden == 1,
               "one iris is not seen clearly; the other stands in for it, or both are drawn");
}

void WarnOfCuts(const FoundFace& face, const fsm::Image& photo, const Completed& completed,
                Warnings& warnings) {
  // The network guesses what it does not see with the same certainty as the rest.
  const std::string cut_off = NamesOf(FindCutOffParts(face, photo));
  warnings.Add(!cut_off.empty(),
               "the photo cuts off part of the head: " + cut_off +
                   "; what it does not show has the form of the toolkit's own head, in colours "
                   "guessed from the rest; a photo of the whole head is needed for a likeness");
  const std::string drawn =
      JoinedNames({{completed.neck, "neck, shoulders and clothes below it"},
                   {completed.shoulders && !completed.neck, "shoulders beside it"},
                   {completed.hair, "hair above or beside it"}},
                  "; ");
  warnings.Add(!drawn.empty(),
               "the photo cuts the figure; drawn in its colours and light: " + drawn +
                   "; a photo with more room round the head shows the person's own");
}

void WarnOfOcclusion(const Occlusion& occlusion, Warnings& warnings) {
  const auto& [covered, part_name] = occlusion;
  warnings.Add(covered >= kMaybeCovered && covered < kSurelyCovered,
               "something may be before the face" + (part_name ? " at " + *part_name : "") +
                   "; hard light, shut eyes or a turned head look like that, too");
  warnings.Add(covered >= kSurelyCovered, "covered by something that is no face" +
                                              (part_name ? ": " + *part_name : "") +
                                              "; what is before the face becomes part of it");
}

std::string WarningsOf(const FrontPhoto& front, const FrontFace& front_face, const FaceFit& fit,
                       const Completed& completed, const BakedHead& baked) {
  const auto& look = PhotoLook().report;
  const FoundFace& face = front_face.found;
  Warnings warnings;
  warnings.Add(glm::length(face.AcrossEyes()) <= look.small_px,
               "the face is small; details will be soft");
  WarnOfPose(fit.head.pose, warnings);
  WarnOfEyes(fit.irises, warnings);
  warnings.Add(Sharpness(face, front.image) <= look.blurred, "the photo is blurred");
  const float left_by_right = SideLight(face, front.image);
  warnings.Add(left_by_right > look.side_light.to || left_by_right <= look.side_light.from,
               "strong light from one side stays in the skin");
  const Expression& expression = fit.head.expression;
  warnings.Add(
      std::max(expression.smile, expression.jaw_drop + expression.lips_part) > look.expression,
      "not a neutral face; some folds of the expression stay in the skin");
  warnings.Add(baked.head.glasses,
               "glasses stay as they are, and so does the skin round the eyes; --glasses no if "
               "there are none");
  WarnOfCuts(face, front.image, completed, warnings);
  if (front_face.occlusion) WarnOfOcclusion(*front_face.occlusion, warnings);
  warnings.Add(front.face_count > 1, "several faces; --face N takes another");
  return warnings.lines();
}

}  // namespace

std::string Report(const FrontPhoto& front, const FrontFace& face, const FaceFit& fit,
                   const Completed& completed, const BakedHead& baked) {
  const glm::vec3 turn_deg = glm::degrees(fit.head.pose.rotation_rad);
  const Expression& expression = fit.head.expression;
  const auto& irises = fit.irises.eyes;
  std::string out = fmt::format(
      "place       nose {} pixels from the left, {} from the top, of {} x {}\n"
      "photo       {} x {} pixels, eyes {:.0f} pixels apart at their outer corners\n"
      "faces       {}\n"
      "certainty   {:.3f}\n"
      "pose        nod {:.1f}, turn {:.1f}, tilt {:.1f} degrees\n"
      "expression  smile {:.2f}, jaw {:.2f}, lips parted {:.2f}\n"
      "irises      {:.2f} and {:.2f} clear (below {:.2f} not seen)\n"
      "residual    {:.2f} mm\n"
      "coverage    {:.0f} % of the face's map\n"
      "glasses     {}\n",
      std::lround(face.nose_whole_px.x), std::lround(face.nose_whole_px.y), front.whole_size_px.x,
      front.whole_size_px.y, front.image.width, front.image.height,
      glm::length(face.found.AcrossEyes()), front.face_count, face.found.certainty, turn_deg.x,
      turn_deg.y, turn_deg.z, expression.smile, expression.jaw_drop, expression.lips_part,
      irises.right.circle.contrast, irises.left.circle.contrast, kClearIris,
      ResidualMm(face.found, fit.head), 100 * baked.coverage, baked.head.glasses ? "yes" : "no");
  if (const auto& occlusion = face.occlusion) {
    out += fmt::format(
        "covered     {:.2f} (from {} on something may be before the face, from {} on it is){}\n",
        occlusion->covered, kMaybeCovered, kSurelyCovered,
        occlusion->part_name ? ", most at " + *occlusion->part_name : "");
  }
  return out + WarningsOf(front, face, fit, completed, baked);
}

}  // namespace facefit
