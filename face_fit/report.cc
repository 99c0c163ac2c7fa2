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

/// Returns a warning as a line of a report; "" if it does not apply.
std::string Warning(bool applies, const std::string& text) {
  return applies ? "warning: " + text + "\n" : "";
}

std::string WarnOfPose(const CameraPose& pose) {
  const auto& look = PhotoLook().report;
  const float turned_deg = std::abs(glm::degrees(pose.rotation_rad.y));
  const float bent_deg = std::abs(glm::degrees(pose.rotation_rad.x));
  return Warning(turned_deg > look.turned_far_deg,
                 fmt::format("the head is turned far; its other side is guessed and may look "
                             "wrong: a photo turned by less than {} degrees is needed, or --view "
                             "with another one",
                             look.turned_deg)) +
         Warning(turned_deg > look.turned_deg && turned_deg <= look.turned_far_deg,
                 "the head is turned; one side is completed from the other") +
         Warning(bent_deg > look.bent_deg, "the head is bent; a level photo fits better");
}

std::string WarnOfEyes(const PhotoIrises& irises) {
  const auto hidden = std::ranges::count(irises.eyes.InOrder(), false, &PhotoIris::seen);
  return Warning(hidden == 2,
                 "no iris is seen: the eyes are shut, look down or lie in the shade; they are "
                 "drawn, and their lids keep what the photo shows on them") +
         Warning(hidden == 1,
                 "one iris is not seen clearly; the other stands in for it, or both are drawn");
}

std::string WarnOfCuts(const FoundFace& face, const fsm::Image& photo, const Completed& completed) {
  // The network guesses what it does not see with the same certainty as the rest.
  const std::string cut_off = NamesOf(FindCutOffParts(face, photo));
  const std::string drawn =
      JoinedNames({{completed.neck, "neck, shoulders and clothes below it"},
                   {completed.shoulders && !completed.neck, "shoulders beside it"},
                   {completed.hair, "hair above or beside it"}},
                  "; ");
  return Warning(!cut_off.empty(),
                 "the photo cuts off part of the head: " + cut_off +
                     "; what it does not show has the form of the toolkit's own head, in colours "
                     "guessed from the rest; a photo of the whole head is needed for a likeness") +
         Warning(!drawn.empty(),
                 "the photo cuts the figure; drawn in its colours and light: " + drawn +
                     "; a photo with more room round the head shows the person's own");
}

std::string WarnOfOcclusion(const Occlusion& occlusion) {
  const auto& [covered, part_name] = occlusion;
  return Warning(covered >= kMaybeCovered && covered < kSurelyCovered,
                 "something may be before the face" + (part_name ? " at " + *part_name : "") +
                     "; hard light, shut eyes or a turned head look like that, too") +
         Warning(covered >= kSurelyCovered, "covered by something that is no face" +
                                                (part_name ? ": " + *part_name : "") +
                                                "; what is before the face becomes part of it");
}

std::string WarningsOf(const FrontPhoto& front, const FrontFace& front_face, const FaceFit& fit,
                       const Completed& completed, const BakedHead& baked) {
  const auto& look = PhotoLook().report;
  const FoundFace& face = front_face.found;
  const float left_by_right = SideLight(face, front.image);
  const Expression& expression = fit.head.expression;
  return Warning(glm::length(face.AcrossEyes()) <= look.small_px,
                 "the face is small; details will be soft") +
         WarnOfPose(fit.head.pose) + WarnOfEyes(fit.irises) +
         Warning(Sharpness(face, front.image) <= look.blurred, "the photo is blurred") +
         Warning(left_by_right > look.side_light.to || left_by_right <= look.side_light.from,
                 "strong light from one side stays in the skin") +
         Warning(std::max(expression.smile, expression.jaw_drop + expression.lips_part) >
                     look.expression,
                 "not a neutral face; some folds of the expression stay in the skin") +
         Warning(baked.head.glasses,
                 "glasses stay as they are, and so does the skin round the eyes; --glasses no if "
                 "there are none") +
         WarnOfCuts(face, front.image, completed) +
         (front_face.occlusion ? WarnOfOcclusion(*front_face.occlusion) : "") +
         Warning(front.face_count > 1, "several faces; --face N takes another");
}

}  // namespace

std::string Report(const FrontPhoto& front, const FrontFace& face, const FaceFit& fit,
                   const Completed& completed, const BakedHead& baked) {
  const glm::vec3 turn_deg = glm::degrees(fit.head.pose.rotation_rad);
  const Expression& expression = fit.head.expression;
  const auto& irises = fit.irises.eyes;
  std::string out =
      fmt::format("place       nose {} pixels from the left, {} from the top, of {} x {}\n",
                  std::lround(face.nose_whole_px.x), std::lround(face.nose_whole_px.y),
                  front.whole_size_px.x, front.whole_size_px.y);
  out +=
      fmt::format("photo       {} x {} pixels, eyes {:.0f} pixels apart at their outer corners\n",
                  front.image.width, front.image.height, glm::length(face.found.AcrossEyes()));
  out += fmt::format("faces       {}\n", front.face_count);
  out += fmt::format("certainty   {:.3f}\n", face.found.certainty);
  out += fmt::format("pose        nod {:.1f}, turn {:.1f}, tilt {:.1f} degrees\n", turn_deg.x,
                     turn_deg.y, turn_deg.z);
  out += fmt::format("expression  smile {:.2f}, jaw {:.2f}, lips parted {:.2f}\n", expression.smile,
                     expression.jaw_drop, expression.lips_part);
  out += fmt::format("irises      {:.2f} and {:.2f} clear (below {:.2f} not seen)\n",
                     irises.right.circle.contrast, irises.left.circle.contrast, kClearIris);
  out += fmt::format("residual    {:.2f} mm\n", ResidualMm(face.found, fit.head));
  out += fmt::format("coverage    {:.0f} % of the face's map\n", 100 * baked.coverage);
  out += fmt::format("glasses     {}\n", baked.head.glasses ? "yes" : "no");
  if (const auto& occlusion = face.occlusion) {
    out += fmt::format(
        "covered     {:.2f} (from {} on something may be before the face, from {} on it is){}\n",
        occlusion->covered, kMaybeCovered, kSurelyCovered,
        occlusion->part_name ? ", most at " + *occlusion->part_name : "");
  }
  return out + WarningsOf(front, face, fit, completed, baked);
}

}  // namespace facefit
