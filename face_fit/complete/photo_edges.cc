#include "face_fit/complete/photo_edges.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Tells hair and clothes from skin by their colours.
class EdgeClassifier {
 public:
  /// `brows`: the row above which a figure is head, hair or hat. `skin`: 0..255.
  EdgeClassifier(const Cutout& figure, float brows, glm::vec3 skin) : skin_(skin) {
    glm::vec3 sum(0);
    float count = 0;
    for (int y = 0; y < std::min(figure.opacity.height, static_cast<int>(brows)); ++y) {
      for (int x = 0; x < figure.opacity.width; ++x) {
        const std::size_t i = figure.opacity.Index(x, y);
        const glm::vec3 colour = Rgb(figure.colours, i);
        if (figure.opacity.at[i] < 0.9F || IsSkin(colour)) continue;
        sum += colour;
        ++count;
      }
    }
    constexpr float kEnough = 20;
    if (count > kEnough) hair_ = sum / count;
  }
  /// The mean of hair or hat; negative where none is seen.
  glm::vec3 hair() const { return hair_; }
  EdgeKind Of(glm::vec3 colour) const {
    const float from_hair = glm::distance(colour, hair_);
    if (IsSkin(colour) && glm::distance(colour, skin_) < from_hair) return EdgeKind::kSkin;
    return from_hair < hair_reach_ ? EdgeKind::kHair : EdgeKind::kCloth;
  }

 private:
  bool IsSkin(glm::vec3 colour) const {
    const float part = Brightness(colour) / std::max(Brightness(skin_), 1.0F);
    return glm::distance(Hue(colour), Hue(skin_)) < hue_reach_ && part > bright_.x &&
           part < bright_.y;
  }
  /// Colour without brightness; of the dark, where it is noise, grey.
  static glm::vec3 Hue(glm::vec3 colour) { return (colour + 8.0F) / (Brightness(colour) + 8); }

  // Numbers of the table that are asked for at each pixel.
  const float hair_reach_ = PhotoLook()("edge_hair_colour");
  const float hue_reach_ = PhotoLook()("edge_skin_hue");
  const glm::vec2 bright_ = PhotoLook().Pair("edge_skin_bright");
  glm::vec3 skin_, hair_{-1e3F};
};

PhotoEdges::Seen EdgeSample(const Cutout& figure, const EdgeClassifier& classifier, glm::ivec2 from,
                            glm::ivec2 size) {
  PhotoEdges::Seen seen;
  const float part = 1 / static_cast<float>(size.x * size.y);
  for (int y = from.y; y < from.y + size.y; ++y) {
    for (int x = from.x; x < from.x + size.x; ++x) {
      const std::size_t i = figure.opacity.Index(x, y);
      seen.colour += part * Rgb(figure.colours, i);
      seen.opacity += part * figure.opacity.at[i];
    }
  }
  if (seen.opacity > 0.5F) seen.kind = classifier.Of(seen.colour);
  return seen;
}

/// How many pixels, at most `most`, follow each other from one on that are the figure's but no
/// skin.
int HairDepth(const Cutout& figure, const EdgeClassifier& classifier, glm::ivec2 from,
              glm::ivec2 step, int most) {
  int count = 0;
  for (glm::ivec2 p = from; count < most; p += step, ++count) {
    const std::size_t i = figure.opacity.Index(p.x, p.y);
    if (figure.opacity.at[i] < 0.5F || classifier.Of(Rgb(figure.colours, i)) == EdgeKind::kSkin)
      break;
  }
  return count;
}

/// Whether most of a column from a row down to the photo's lower edge belongs to the figure and, if
/// a classifier is given, is hair by its colour: what hangs from the head, no collar.
bool HangsDown(const Cutout& figure, const EdgeClassifier* classifier_or_null, int x, float from) {
  int hanging = 0, rows = 0;
  for (int y = std::max(static_cast<int>(from), 0); y < figure.opacity.height; ++y, ++rows) {
    const std::size_t i = figure.opacity.Index(x, y);
    hanging +=
        figure.opacity.at[i] > 0.5F &&
        (!classifier_or_null || classifier_or_null->Of(Rgb(figure.colours, i)) == EdgeKind::kHair);
  }
  constexpr float kHangingPart = 0.8F;
  return static_cast<float>(hanging) >= kHangingPart * static_cast<float>(rows);
}

}  // namespace

PhotoEdges::PhotoEdges(const FittedHead& fitted, const Cutout& figure, glm::vec3 skin) {
  const int width = figure.opacity.width, height = figure.opacity.height;
  const glm::vec3 forehead = fitted.At(point::kForehead);
  const EdgeClassifier classifier(figure, fitted.pose.Pixel(forehead).y, skin);
  const glm::vec2 chin = fitted.pose.Pixel(fitted.At(point::kChin));
  const auto& look = PhotoLook();
  const float per_mm = fitted.pose.PixelsPerMm();
  const int wanted = static_cast<int>(look("edge_band") * per_mm);
  const int down = std::clamp(wanted, 1, height), across = std::clamp(wanted, 1, width);
  for (int x = 0; x < width; ++x) {
    top_.push_back(EdgeSample(figure, classifier, {x, 0}, {1, down}));
    top_.back().hair_depth = HairDepth(figure, classifier, {x, 0}, {0, 1}, height);
    bottom_.push_back(EdgeSample(figure, classifier, {x, height - down}, {1, down}));
    EdgeKind& kind = bottom_.back().kind;
    const float from = std::min(chin.y, static_cast<float>(height) - look("edge_hangs") * per_mm);
    if (kind == EdgeKind::kHair && !HangsDown(figure, &classifier, x, from))
      kind = EdgeKind::kCloth;
  }
  if ((static_cast<float>(height) - chin.y) / per_mm < look("edge_above_shoulders")) {
    ClassifyNeck(figure, chin, per_mm);
  }
  for (const PhotoEdge edge : kPhotoEdges) {
    const bool left = edge == PhotoEdge::kLeft;
    for (int y = 0; y < height; ++y) {
      aside_[edge].push_back(
          EdgeSample(figure, classifier, {left ? 0 : width - across, y}, {across, 1}));
      aside_[edge].back().hair_depth =
          HairDepth(figure, classifier, {left ? 0 : width - 1, y}, {left ? 1 : -1, 0}, width);
    }
    // Hair hangs down from the head: dark cloth below a gap is none.
    bool gap = false;
    for (int y = std::max(static_cast<int>(chin.y), 0); y < height; ++y) {
      EdgeKind& kind = aside_[edge][static_cast<std::size_t>(y)].kind;
      gap = gap || kind == EdgeKind::kNothing;
      if (gap && kind == EdgeKind::kHair) kind = EdgeKind::kCloth;
    }
  }
  hair_ = classifier.hair().r < 0 ? HairBeside(chin.y, skin) : classifier.hair();
}

glm::vec3 PhotoEdges::HairBeside(float chin, glm::vec3 skin) const {
  // Hair of the skin's brightness and hue, as grey and blond hair, is told from it by its place.
  glm::vec4 sum(0);
  for (const PhotoEdge edge : kPhotoEdges) {
    const std::vector<Seen>& seen = aside_[edge];
    for (std::size_t y = 0; y < seen.size() && static_cast<float>(y) < chin; ++y) {
      if (seen[y].kind != EdgeKind::kNothing) sum += glm::vec4(seen[y].colour, 1);
    }
  }
  return sum.w > 0 ? glm::vec3(sum) / sum.w : PhotoLook()("hair_by_skin") * skin;
}

void PhotoEdges::ClassifyNeck(const Cutout& figure, glm::vec2 chin, float per_mm) {
  // By colour alone brown hair is skin in warm light, and the shade on a neck is cloth. Above the
  // shoulders only hair hangs beside the neck, and tips of a collar stand there; the neck itself is
  // bare or in a collar.
  const auto& look = PhotoLook();
  const auto aside = [&](std::size_t x) {
    return std::abs(static_cast<float>(x) + 0.5F - chin.x) / per_mm;
  };
  const float end = static_cast<float>(height()), below = (end - chin.y) / per_mm;
  const float neck = look("edge_neck");
  int cloth = 0, all = 0;
  for (std::size_t x = 0; x < bottom_.size(); ++x) {
    if (aside(x) > neck) continue;
    cloth += bottom_[x].kind == EdgeKind::kCloth;
    ++all;
  }
  const bool collar = below > look("edge_at_chin") && 2 * cloth > all;
  const bool at_jaw = below < look("edge_at_jaw");
  const auto beside_neck = [&](std::size_t x) {
    // Lower down skin beside the neck may be a raised shoulder.
    if (!at_jaw && bottom_[x].kind == EdgeKind::kSkin) return false;
    return aside(x) > look("edge_beside_neck") + (at_jaw ? look("edge_jaw") : 0);
  };
  for (std::size_t x = 0; x < bottom_.size(); ++x) {
    EdgeKind& kind = bottom_[x].kind;
    if (kind == EdgeKind::kCloth && !collar && !beside_neck(x)) {
      kind = aside(x) > neck ? EdgeKind::kTip : EdgeKind::kSkin;
    }
    if (kind == EdgeKind::kNothing || !beside_neck(x)) continue;
    // A lock hangs down in some of its columns at least.
    std::size_t last = x;
    bool hangs = false;
    const float from = end - look("edge_hangs") * per_mm;
    for (; last < bottom_.size() && bottom_[last].kind != EdgeKind::kNothing && beside_neck(last);
         ++last) {
      hangs = hangs || HangsDown(figure, nullptr, static_cast<int>(last), from);
    }
    for (; x < last; ++x) bottom_[x].kind = hangs ? EdgeKind::kHair : EdgeKind::kTip;
    --x;
  }
}

}  // namespace facefit
