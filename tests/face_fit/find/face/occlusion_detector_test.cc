// Photos with something drawn before the face. The photos are not part of the repository
// (tests/README.md); without them or the networks the tests are skipped.

#include "face_fit/find/face/occlusion_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/photo.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/support/test_data.h"

namespace facefit {
namespace {

/// Those of them that are there.
std::vector<std::string> Photos() {
  std::vector<std::string> photos{"collins_nasa.png", "hopper_usnavy.jpg",
                                  "lincoln_1863_gardner.jpg"};
  std::erase_if(photos, [](const std::string& name) { return !support::Photos().Has(name); });
  return photos;
}

/// What is drawn at a place: colour 0..255 and opacity 0..1; `below`: the photo's own colour.
/// Places in millimetres, x to the person's left, y down, between the outer corners of the eyes,
/// which lie 90 apart.
using Drawing = std::function<glm::vec4(glm::vec2 place, glm::vec3 below)>;

class OcclusionDetectorTest : public NetworkTest {
 protected:
  static void TearDownTestSuite() {
    seen_.clear();
    NetworkTest::TearDownTestSuite();
  }
  void SetUp() override {
    if (Photos().empty()) GTEST_SKIP() << support::Photos().Missing();
    NetworkTest::SetUp();
  }

  static FoundFace Find(const fsm::Image& photo) {
    const auto faces = FindFaces(*networks_, photo);
    EXPECT_FALSE(faces.empty());
    return faces.empty() ? FoundFace{} : faces[0];
  }

  static Occlusion Look(const std::string& name, const Drawing& drawing = {}) {
    const Seen& seen = AsItIs(name);
    if (!drawing) return DetectOcclusion(*networks_, Galatea(), seen.face, seen.photo);
    fsm::Image photo = seen.photo;
    Draw(seen.face, drawing, photo);
    return DetectOcclusion(*networks_, Galatea(), Find(photo), photo);
  }

 private:
  /// A photo with nothing drawn on it, read and looked at once.
  struct Seen {
    fsm::Image photo;
    FoundFace face;
  };
  static const Seen& AsItIs(const std::string& name) {
    const auto known = seen_.find(name);
    if (known != seen_.end()) return known->second;
    auto photo = ReadPhoto(support::Photos() / name);
    if (!photo) throw std::runtime_error(photo.error().text);
    const FoundFace face = Find(*photo);
    return seen_[name] = {std::move(*photo), face};
  }

  static void Draw(const FoundFace& face, const Drawing& drawing, fsm::Image& photo) {
    const glm::vec2 right(face.points[33]), left(face.points[263]), middle = 0.5F * (right + left);
    const glm::vec2 across = (left - right) / 90.0F;
    const float square = glm::dot(across, across);
    for (int y = 0; y < photo.height; ++y) {
      for (int x = 0; x < photo.width; ++x) {
        const glm::vec2 off = glm::vec2(x, y) + 0.5F - middle;
        const glm::vec2 place(glm::dot(off, across) / square,
                              glm::dot(off, glm::vec2(-across.y, across.x)) / square);
        std::uint8_t* pixel = &photo.rgba[static_cast<std::size_t>(4 * (y * photo.width + x))];
        const glm::vec3 below(pixel[0], pixel[1], pixel[2]);
        const glm::vec4 over = drawing(place, below);
        const glm::vec3 out = glm::mix(below, glm::vec3(over), over.a);
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(out[c] + 0.5F);
      }
    }
  }

  static inline std::map<std::string, Seen> seen_;
};

TEST_F(OcclusionDetectorTest, NothingIsBeforeTheFacesAsTheyAre) {
  for (const std::string& photo : Photos()) EXPECT_LT(Look(photo).covered, 1) << photo;
}

TEST_F(OcclusionDetectorTest, ShadeABeardAndRoundGlassesCoverNothing) {
  const Drawing shade = [](glm::vec2 place, glm::vec3 below) {
    const float lit = 0.55F + 0.45F / (1 + std::exp(place.x / 12));
    return glm::vec4(lit * below, 1);
  };
  const Drawing beard = [](glm::vec2 place, glm::vec3) {
    const float jaw = glm::length((place - glm::vec2(0, 70)) / glm::vec2(58, 52));
    const float lips = glm::length((place - glm::vec2(0, 56)) / glm::vec2(26, 11));
    const float hair = glm::smoothstep(1.05F, 0.85F, jaw) * glm::smoothstep(40.0F, 52.0F, place.y) *
                       glm::smoothstep(0.9F, 1.2F, lips);
    // Hairs, as dense as chance will have it.
    const float strand =
        glm::fract(43758.5F * std::sin(glm::dot(place, glm::vec2(12.99F, 78.23F))));
    return glm::vec4(50, 38, 32, hair * (0.45F + 0.35F * strand));
  };
  const Drawing glasses = [](glm::vec2 place, glm::vec3) {
    const float ring = glm::length(glm::vec2(std::abs(place.x) - 31, place.y - 3));
    const bool bridge = std::abs(place.x) < 9 && std::abs(place.y + 2) < 1.5F;
    return glm::vec4(40, 30, 28, std::abs(ring - 21) < 1.5F || bridge ? 1 : 0);
  };
  for (const std::string& photo : Photos()) {
    EXPECT_LT(Look(photo, shade).covered, 1) << photo;
    EXPECT_LT(Look(photo, beard).covered, 1) << photo;
    EXPECT_LT(Look(photo, glasses).covered, 1) << photo;
  }
}

TEST_F(OcclusionDetectorTest, AMaskIsFoundOnMouthAndCheeks) {
  for (const glm::vec3 cloth : {glm::vec3(168, 200, 222), glm::vec3(236, 236, 232)}) {
    const Drawing mask = [&cloth](glm::vec2 place, glm::vec3) {
      const float top = 14 + 0.13F * std::abs(place.x);
      const bool on = place.y > top && glm::length(place / glm::vec2(66, 127)) < 1;
      const float round = 1 - 0.28F * place.x * place.x / (66 * 66);
      return glm::vec4(round * cloth, on ? 1 : 0);
    };
    for (const std::string& photo : Photos()) {
      const Occlusion occlusion = Look(photo, mask);
      EXPECT_GT(occlusion.covered, 1.5F) << photo;
      EXPECT_NE(occlusion.part_name.value_or("").find("mouth"), std::string::npos)
          << photo << ": " << occlusion.part_name.value_or("");
    }
  }
}

TEST_F(OcclusionDetectorTest, AHandOfTheSkinsColourIsFoundOnTheMouth) {
  // Four fingers from the person's right, rounded by shade, dark between them.
  const Drawing hand = [](glm::vec2 place, glm::vec3) {
    const float finger = (place.y - 46) / 15;
    if (finger < 0 || finger >= 4 || place.x > 30 - 4 * std::floor(finger)) return glm::vec4(0);
    const float round = 2 * glm::fract(finger) - 1;
    const float light = 0.4F + 0.6F * std::sqrt(1 - round * round);
    return glm::vec4(light * glm::vec3(205, 150, 125), 1);
  };
  for (const std::string& photo : Photos()) {
    const Occlusion occlusion = Look(photo, hand);
    EXPECT_GT(occlusion.covered, 1) << photo;
    // Of one photo it is known that something covers the face, but not what.
    EXPECT_NE(occlusion.part_name.value_or("mouth").find("mouth"), std::string::npos)
        << photo << ": " << occlusion.part_name.value_or("");
  }
}

TEST_F(OcclusionDetectorTest, SidesAreThePersons) {
  if (const auto photos = support::Photos(); !photos.Has("hopper_usnavy.jpg"))
    GTEST_SKIP() << photos.Missing();
  for (const float side : {-1.0F, 1.0F}) {
    const Drawing curtain = [side](glm::vec2 place, glm::vec3) {
      return glm::vec4(40, 42, 48, side * place.x > 14 && std::abs(place.y - 30) < 90 ? 1 : 0);
    };
    const Occlusion occlusion = Look("hopper_usnavy.jpg", curtain);
    EXPECT_GT(occlusion.covered, 1);
    EXPECT_NE(occlusion.part_name.value_or("").find(side < 0 ? "right" : "left"), std::string::npos)
        << occlusion.part_name.value_or("");
  }
}

}  // namespace
}  // namespace facefit
