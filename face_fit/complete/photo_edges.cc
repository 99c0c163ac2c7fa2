#include "face_fit/complete/photo_edges.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <optional>

#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

constexpr float kFigureOpacity = 0.5F;  // opacity above which a pixel belongs to the figure
constexpr float kWholeOpacity = 0.9F;   // opacity from which a pixel's colour is the figure's alone
constexpr float kMinHairPixels = 20;    // pixels that a mean colour of hair needs
constexpr float kHangingShare = 0.8F;   // share of a column that must be figure for it to hang down

/// Tells hair and clothes from skin by their colours.
class EdgeClassifier {
 public:
  /// `forehead_top`: row of the upper end of the forehead; everything above it is head, hair or
  /// hat. `skin_colour`: 0..255.
  EdgeClassifier(const FigureCutout& figure, float forehead_top, glm::vec3 skin_colour)
      : skin_colour_(skin_colour) {
    glm::vec3 sum(0);
    float count = 0;
    for (int y = 0; y < std::min(figure.opacity.height, static_cast<int>(forehead_top)); ++y) {
      for (int x = 0; x < figure.opacity.width; ++x) {
        const std::size_t i = figure.opacity.Index(x, y);
        const glm::vec3 colour = Rgb(figure.colours, i);
        if (figure.opacity[i] < kWholeOpacity || IsSkin(colour)) continue;
        sum += colour;
        ++count;
      }
    }
    if (count > kMinHairPixels) hair_ = sum / count;
  }
  /// Returns the mean colour of hair or hat; nothing where none is seen.
  std::optional<glm::vec3> hair() const { return hair_; }
  EdgeKind KindOf(glm::vec3 colour) const {
    const float from_hair =
        hair_ ? glm::distance(colour, *hair_) : std::numeric_limits<float>::infinity();
    if (IsSkin(colour) && glm::distance(colour, skin_colour_) < from_hair) return EdgeKind::kSkin;
    return from_hair < PhotoLook().edge.hair_colour_difference ? EdgeKind::kHair : EdgeKind::kCloth;
  }

 private:
  bool IsSkin(glm::vec3 colour) const {
    const float brightness = Brightness(colour) / std::max(Brightness(skin_colour_), 1.0F);
    const auto& look = PhotoLook().edge;
    return glm::distance(Hue(colour), Hue(skin_colour_)) < look.skin_hue_difference &&
           look.skin_brightness.Contains(brightness);
  }
  /// Returns the colour divided by its brightness; dark colours, whose hue is noise, tend to grey.
  static glm::vec3 Hue(glm::vec3 colour) {
    constexpr float kDark = 8;  // of 255
    return (colour + kDark) / (Brightness(colour) + kDark);
  }

  glm::vec3 skin_colour_;
  std::optional<glm::vec3> hair_;
};

/// Converts rows and columns of a photo to millimetres below the chin and beside it.
struct ChinFrame {
  glm::vec2 pixel;  ///< of the chin
  float pixels_per_mm;
  float BelowMm(int row) const { return (static_cast<float>(row) - pixel.y) / pixels_per_mm; }
  float BesideMm(std::size_t x) const {
    return std::abs(static_cast<float>(x) + 0.5F - pixel.x) / pixels_per_mm;
  }
};

/// Samples the edges of a figure and classifies them by colour alone.
class EdgeReader {
 public:
  EdgeReader(const FigureCutout& figure, const EdgeClassifier& classifier)
      : figure_(figure), classifier_(classifier) {}

  /// Returns the mean over a rectangle of pixels.
  EdgeSample Sample(glm::ivec2 from, glm::ivec2 size) const {
    EdgeSample sample;
    const float share = 1 / static_cast<float>(size.x * size.y);
    for (int y = from.y; y < from.y + size.y; ++y) {
      for (int x = from.x; x < from.x + size.x; ++x) {
        const std::size_t i = figure_.opacity.Index(x, y);
        sample.colour += share * Rgb(figure_.colours, i);
        sample.opacity += share * figure_.opacity[i];
      }
    }
    if (sample.opacity > kFigureOpacity) sample.kind = classifier_.KindOf(sample.colour);
    return sample;
  }
  /// Counts the figure's pixels that are not skin from `from` on in direction `step`, up to `most`.
  int HairReach(glm::ivec2 from, glm::ivec2 step, int most) const {
    int count = 0;
    for (glm::ivec2 p = from; count < most; p += step, ++count) {
      const std::size_t i = figure_.opacity.Index(p.x, p.y);
      if (figure_.opacity[i] < kFigureOpacity || KindOf(i) == EdgeKind::kSkin) break;
    }
    return count;
  }
  /// Returns whether most of a column between row `from` and the lower edge belongs to the figure,
  /// so that something hangs from the head and is not a collar.
  bool HangsDown(std::size_t x, float from) const {
    return MostOf(x, from, [](std::size_t) { return true; });
  }
  /// Returns whether most of that part of the column is figure in the hair's colour.
  bool HairHangsDown(std::size_t x, float from) const {
    return MostOf(x, from, [this](std::size_t i) { return KindOf(i) == EdgeKind::kHair; });
  }

 private:
  EdgeKind KindOf(std::size_t i) const { return classifier_.KindOf(Rgb(figure_.colours, i)); }
  bool MostOf(std::size_t x, float from, auto counts) const {
    int hanging = 0, rows = 0;
    for (int y = std::max(static_cast<int>(from), 0); y < figure_.opacity.height; ++y, ++rows) {
      const std::size_t i = figure_.opacity.Index(static_cast<int>(x), y);
      hanging += figure_.opacity[i] > kFigureOpacity && counts(i);
    }
    return static_cast<float>(hanging) >= kHangingShare * static_cast<float>(rows);
  }

  const FigureCutout& figure_;
  const EdgeClassifier& classifier_;
};

/// Classifies the lower edge of a photo that ends above the shoulders by the places of its samples:
/// by colour alone brown hair would be skin in warm light, and the shade on a neck cloth. There
/// only hair hangs beside the neck, and only tips of a collar stand; the neck itself is bare or in
/// a collar. `below_mm`: distance from the chin to the edge; `hang_from`: as for HangsDown.
void ClassifyByPlace(const EdgeReader& reader, const ChinFrame& chin, float below_mm,
                     float hang_from, std::vector<EdgeSample>& bottom) {
  const auto& neck = PhotoLook().neck;
  int cloth = 0, columns = 0;
  for (std::size_t x = 0; x < bottom.size(); ++x) {
    if (chin.BesideMm(x) > neck.half_width_mm) continue;
    cloth += bottom[x].kind == EdgeKind::kCloth;
    ++columns;
  }
  const bool collar = below_mm > neck.collar_mm && 2 * cloth > columns;
  const bool at_jaw = below_mm < neck.jaw_mm;
  const float beyond_mm = neck.ends_mm + (at_jaw ? neck.jaw_wider_mm : 0);
  std::vector<bool> beyond_neck;
  for (std::size_t x = 0; x < bottom.size(); ++x) {
    EdgeKind& kind = bottom[x].kind;
    const bool beyond = chin.BesideMm(x) > beyond_mm;
    // Below the jaw skin beside the neck may be a raised shoulder.
    beyond_neck.push_back(beyond && kind != EdgeKind::kNothing &&
                          (kind != EdgeKind::kSkin || at_jaw));
    if (beyond || kind != EdgeKind::kCloth || collar) continue;
    kind = chin.BesideMm(x) > neck.half_width_mm ? EdgeKind::kTip : EdgeKind::kSkin;
  }
  // A stretch beyond the neck is hair if a lock hangs down in any of its columns.
  for (std::size_t from = 0; from < bottom.size(); ++from) {
    std::size_t to = from;
    bool hangs = false;
    for (; to < bottom.size() && beyond_neck[to]; ++to) {
      hangs = hangs || reader.HangsDown(to, hang_from);
    }
    for (; from < to; ++from) bottom[from].kind = hangs ? EdgeKind::kHair : EdgeKind::kTip;
  }
}

std::vector<EdgeSample> ReadBottom(const EdgeReader& reader, const ChinFrame& chin, glm::ivec2 size,
                                   int band) {
  const auto& look = PhotoLook();
  const float hang_from = static_cast<float>(size.y) - look.neck.hair_hang_mm * chin.pixels_per_mm;
  std::vector<EdgeSample> bottom;
  for (int x = 0; x < size.x; ++x) {
    EdgeSample& sample = bottom.emplace_back(reader.Sample({x, size.y - band}, {1, band}));
    if (sample.kind == EdgeKind::kHair &&
        !reader.HairHangsDown(static_cast<std::size_t>(x), std::min(chin.pixel.y, hang_from))) {
      sample.kind = EdgeKind::kCloth;
    }
  }
  const float below_mm = chin.BelowMm(size.y);
  if (below_mm < look.neck.no_shoulders_mm) {
    ClassifyByPlace(reader, chin, below_mm, hang_from, bottom);
  }
  return bottom;
}

std::vector<EdgeSample> ReadTop(const EdgeReader& reader, glm::ivec2 size, int band) {
  std::vector<EdgeSample> top;
  for (int x = 0; x < size.x; ++x) {
    top.push_back(reader.Sample({x, 0}, {1, band}));
    top.back().hair_reach_px = reader.HairReach({x, 0}, {0, 1}, size.y);
  }
  return top;
}

std::vector<EdgeSample> ReadSide(const EdgeReader& reader, PhotoEdge side, float chin_row,
                                 glm::ivec2 size, int band) {
  const bool left = side == PhotoEdge::kLeft;
  std::vector<EdgeSample> samples;
  for (int y = 0; y < size.y; ++y) {
    samples.push_back(reader.Sample({left ? 0 : size.x - band, y}, {band, 1}));
    samples.back().hair_reach_px =
        reader.HairReach({left ? 0 : size.x - 1, y}, {left ? 1 : -1, 0}, size.x);
  }
  // Hair hangs from the head without a gap: dark pixels below a gap are cloth.
  bool gap = false;
  for (int y = std::max(static_cast<int>(chin_row), 0); y < size.y; ++y) {
    EdgeKind& kind = samples[static_cast<std::size_t>(y)].kind;
    gap = gap || kind == EdgeKind::kNothing;
    if (gap && kind == EdgeKind::kHair) kind = EdgeKind::kCloth;
  }
  return samples;
}

/// Returns the mean colour of the figure at both sides above the chin. That is hair or hat even
/// where it has the skin's brightness and hue, as grey and blond hair do. Returns darkened skin if
/// the figure does not touch the sides.
glm::vec3 HairBeside(const PerPhotoEdge<std::vector<EdgeSample>>& sides, float chin_row,
                     glm::vec3 skin_colour) {
  glm::vec4 sum(0);
  for (const PhotoEdge side : kPhotoEdges) {
    const auto& samples = sides[side];
    for (std::size_t y = 0; y < samples.size() && static_cast<float>(y) < chin_row; ++y) {
      if (samples[y].kind != EdgeKind::kNothing) sum += glm::vec4(samples[y].colour, 1);
    }
  }
  return sum.w > 0 ? glm::vec3(sum) / sum.w : PhotoLook().hair.unseen_by_skin * skin_colour;
}

}  // namespace

bool PhotoEdges::TopCutsWholeEdge() const {
  return std::ranges::find(top_, EdgeKind::kNothing, &EdgeSample::kind) == top_.end();
}

PhotoEdges::PhotoEdges(const FittedHead& fitted, const FigureCutout& figure,
                       glm::vec3 skin_colour) {
  const glm::ivec2 size(figure.opacity.width, figure.opacity.height);
  assert(size.x > 0 && size.y > 0);
  const EdgeClassifier classifier(
      figure, fitted.pose.PixelOf(fitted.PositionOf(point::kForehead)).y, skin_colour);
  const EdgeReader reader(figure, classifier);
  const ChinFrame chin{fitted.pose.PixelOf(fitted.PositionOf(point::kChin)),
                       fitted.pose.PixelsPerMm()};
  const glm::ivec2 band =
      glm::min(glm::ivec2(MmToPixels(PhotoLook().edge.band_mm, chin.pixels_per_mm)), size);
  bottom_ = ReadBottom(reader, chin, size, band.y);
  top_ = ReadTop(reader, size, band.y);
  for (const PhotoEdge side : kPhotoEdges) {
    sides_[side] = ReadSide(reader, side, chin.pixel.y, size, band.x);
  }
  hair_ = classifier.hair() ? *classifier.hair() : HairBeside(sides_, chin.pixel.y, skin_colour);
}

}  // namespace facefit
