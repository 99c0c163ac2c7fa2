#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "face_track/model/seen_face.h"
#include "film_dub/paint/mouth_painter.h"

namespace filmdub {
namespace {

constexpr int kWide = 320, kHigh = 300;

/// The network's points of the usual face from the front.
std::vector<glm::vec2> Points() {
  std::vector<glm::vec2> points;
  for (const glm::vec3 p : facetrack::SeenFace::Shipped().rest) {
    points.emplace_back(160 + 1.4F * p.x, 130 - 1.4F * p.y);
  }
  return points;
}

/// Skin that grows darker downwards, times `light`.
fsm::Image Skin(float light) {
  fsm::Image image = fsm::FilledImage(kWide, kHigh);
  for (int y = 0; y < kHigh; ++y) {
    for (int x = 0; x < kWide; ++x) {
      const float v = light * (210 - 0.2F * static_cast<float>(y));
      for (std::size_t c = 0; c < 3; ++c) {
        image.rgba[4 * image.Index(x, y) + c] =
            static_cast<std::uint8_t>(v * (1 - 0.2F * static_cast<float>(c)));
      }
    }
  }
  return image;
}

int MostDifference(const fsm::Image& a, const fsm::Image& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    most = std::max(most, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
  }
  return most;
}

TEST(MouthPainterTest, ADarkerDrawingOfTheSameSkinIsNotSeen) {
  const fsm::Image film = Skin(1), drawn = Skin(0.8F);
  fsm::Image out = film;
  PaintMouth(out, Points(), {.picture = &drawn, .placing = {}, .points = Points()}, 1);
  EXPECT_LE(MostDifference(film, out), 3);
}

TEST(MouthPainterTest, OnlyMouthAndChinArePaintedOver) {
  const fsm::Image film = Skin(1);
  fsm::Image drawn = film, out = film;
  const auto points = Points();
  const glm::vec2 lips = points[13];
  for (int y = -6; y <= 6; ++y) {
    for (int x = -12; x <= 12; ++x) {
      const auto i = 4 * drawn.Index(static_cast<int>(lips.x) + x, static_cast<int>(lips.y) + y);
      drawn.rgba[i] = drawn.rgba[i + 1] = drawn.rgba[i + 2] = 20;
    }
  }
  PaintMouth(out, points, {.picture = &drawn, .placing = {}, .points = points}, 1);
  EXPECT_LT(out.rgba[4 * out.Index(static_cast<int>(lips.x), static_cast<int>(lips.y))], 60);
  for (int y = 0; y < kHigh; ++y) {
    for (int x = 0; x < kWide; ++x) {
      const bool near =
          static_cast<float>(y) > points[2].y && std::abs(static_cast<float>(x) - lips.x) < 60;
      if (near) continue;
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_EQ(out.rgba[4 * out.Index(x, y) + c], film.rgba[4 * film.Index(x, y) + c])
            << x << " " << y;
      }
    }
  }
  fsm::Image none = film;
  PaintMouth(none, points, {.picture = &drawn, .placing = {}, .points = points}, 0);
  EXPECT_EQ(MostDifference(none, film), 0) << "a share of nothing";
}

TEST(MouthPainterTest, BelowTheChinWhatDiffersStaysTheFilms) {
  const auto points = Points();
  const fsm::Image drawn = Skin(1);
  fsm::Image film = drawn;  // a dark coat from a little below the chin
  const int coat = static_cast<int>(points[152].y) + 2;
  for (int y = coat; y < kHigh; ++y) {
    for (int x = 0; x < kWide; ++x) {
      for (std::size_t c = 0; c < 3; ++c) film.rgba[4 * film.Index(x, y) + c] = 30;
    }
  }
  fsm::Image out = film;
  PaintMouth(out, points, {.picture = &drawn, .placing = {}, .points = points}, 1);
  for (int y = coat + 5; y < kHigh; ++y) {
    EXPECT_NEAR(out.rgba[4 * out.Index(static_cast<int>(points[152].x), y)], 30, 3) << y;
  }
}

TEST(MouthPainterTest, OfAChinThatIsHigherNowNothingIsLeftWhereItWas) {
  const auto points = Points();
  // A dark line along the chin, which falls off over a neck.
  const auto face = [&](float lower) {
    fsm::Image image = Skin(1);
    for (int x = 0; x < kWide; ++x) {
      const float aside = (static_cast<float>(x) - points[152].x) / 60;
      const int edge = static_cast<int>(points[152].y + lower - 14 * aside * aside);
      for (int y = edge - 2; y <= edge + 1; ++y) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * image.Index(x, y) + c] = 60;
      }
    }
    return image;
  };
  auto open = points;  // the jaw of the film is lower
  for (const int i : {379, 378, 400, 377, 152, 148, 176, 149, 150}) {
    open[static_cast<std::size_t>(i)].y += 10;
  }
  const fsm::Image film = face(10), drawn = face(0);
  fsm::Image out = film;
  PaintMouth(out, open, {.picture = &drawn, .placing = {}, .points = points}, 1);
  const auto at = [&](const fsm::Image& image, float below) {
    return int{image.rgba[4 * image.Index(static_cast<int>(points[152].x),
                                          static_cast<int>(points[152].y + below))]};
  };
  ASSERT_LT(at(film, 10), 80);
  EXPECT_LT(at(out, 0), 110);
  for (float below = 5; below < 40; ++below) EXPECT_GT(at(out, below), 120) << below;
}

TEST(MouthPainterTest, WhatIsDrawnBecomesAsSharpAsTheFilm) {
  const auto points = Points();
  // Pores: a pattern of single pixels, fainter in what is drawn.
  const auto skin = [&](int depth) {
    fsm::Image image = Skin(1);
    for (int y = 0; y < kHigh; ++y) {
      for (int x = 0; x < kWide; ++x) {
        const int by = (7 * x + 13 * y) % 5 < 2 ? depth : 0;
        for (std::size_t c = 0; c < 3; ++c) {
          auto& v = image.rgba[4 * image.Index(x, y) + c];
          v = static_cast<std::uint8_t>(v - by);
        }
      }
    }
    return image;
  };
  const fsm::Image film = skin(16), drawn = skin(8);
  fsm::Image out = film;
  PaintMouth(out, points, {.picture = &drawn, .placing = {}, .points = points}, 1);
  const auto depth = [&](const fsm::Image& image) {
    const auto x = static_cast<int>(points[17].x), y = static_cast<int>(points[17].y) + 4;
    int least = 255, most = 0;
    for (int i = -4; i <= 4; ++i) {
      const int v = image.rgba[4 * image.Index(x + i, y)];
      least = std::min(least, v);
      most = std::max(most, v);
    }
    return most - least;
  };
  EXPECT_NEAR(depth(out), depth(film), 4);
  EXPECT_LT(depth(drawn), depth(film) - 5) << "else this would say nothing";
}

TEST(MouthPainterTest, BesideTheMouthWhatDiffersStaysTheFilms) {
  const auto points = Points();
  const fsm::Image film = Skin(1);
  fsm::Image drawn = film, out = film;  // with a lock of dark hair over the cheek
  const int lock = static_cast<int>(1.45F * points[291].x - 0.45F * points[13].x);
  const int row = static_cast<int>(points[13].y);
  for (int y = 0; y < kHigh; ++y) {
    for (int x = lock - 3; x <= lock + 3; ++x) {
      for (std::size_t c = 0; c < 3; ++c) drawn.rgba[4 * drawn.Index(x, y) + c] = 20;
    }
  }
  PaintMouth(out, points, {.picture = &drawn, .placing = {}, .points = points}, 1);
  EXPECT_NEAR(out.rgba[4 * out.Index(lock, row)], film.rgba[4 * film.Index(lock, row)], 12);
}

TEST(MouthPainterTest, GrainIsAddedWhereTheMouthIsDrawn) {
  const auto points = Points();
  const fsm::Image film = Skin(1);
  fsm::Image out = film;
  PaintMouth(out, points,
             {.picture = &film, .placing = {}, .points = points, .grain = 4.0 / 255, .seed = 3}, 1);
  double squares = 0;
  int count = 0;
  for (int y = -5; y <= 5; ++y) {
    for (int x = -15; x <= 15; ++x, ++count) {
      const auto i =
          4 * out.Index(static_cast<int>(points[13].x) + x, static_cast<int>(points[13].y) + y);
      squares += std::pow(int{out.rgba[i]} - int{film.rgba[i]}, 2);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 4, 0.7);
}

TEST(MouthPainterTest, AFaceAtTheEdgeOfThePictureIsPaintedAsFarAsItIsThere) {
  const auto points = Points();
  const glm::vec2 lips = points[13];
  const glm::vec2 aside(static_cast<float>(kWide) - lips.x - 10, 0);
  auto seen = points;
  for (glm::vec2& p : seen) p += aside;
  const fsm::Image film = Skin(1);
  fsm::Image drawn = film, out = film;
  for (int x = -12; x <= 12; ++x) {
    const auto i = 4 * drawn.Index(static_cast<int>(lips.x) + x, static_cast<int>(lips.y));
    drawn.rgba[i] = drawn.rgba[i + 1] = drawn.rgba[i + 2] = 20;
  }
  PaintMouth(out, seen,
             {.picture = &drawn, .placing = {{1, 0, aside.x, 0, 1, 0}}, .points = points}, 1);
  EXPECT_LT(out.rgba[4 * out.Index(kWide - 8, static_cast<int>(lips.y))], 60);
}

TEST(PlacingTest, AnAffineMapIsFoundAgain) {
  const Placing truth{{0.9F, 0.1F, 12, -0.1F, 1.1F, -7}};
  const auto drawn = Points();
  std::vector<glm::vec2> seen;
  for (const glm::vec2 p : drawn) seen.push_back(truth(p));
  const Placing found = PlaceOnFilm(drawn, seen);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(found.m[k], truth.m[k], 2e-3F);
}

TEST(PlacingTest, ADroppedJawMovesNothingAndAChinThatIsAsideIsFollowed) {
  const auto drawn = Points();
  auto dropped = drawn, aside = drawn;
  for (const std::size_t i : {152U, 148U, 377U, 176U, 400U, 149U, 378U}) {
    dropped[i].y += 12;
    aside[i].x += 6;
  }
  const glm::vec2 nose = drawn[1], chin = drawn[152];
  EXPECT_LT(glm::distance(PlaceOnFilm(drawn, dropped)(nose), nose), 0.01F);
  EXPECT_LT(glm::distance(PlaceOnFilm(drawn, dropped)(chin), chin), 0.01F);
  const Placing slanted = PlaceOnFilm(drawn, aside);
  EXPECT_NEAR(slanted(chin).x, chin.x + 6, 2);
  EXPECT_NEAR(slanted(chin).y, chin.y, 0.01F);
  EXPECT_NEAR(slanted(drawn[168]).x, drawn[168].x, 2);
}

TEST(PlacingTest, SmoothingKeepsWhatIsSteadyAndStopsAtGaps) {
  std::vector<std::optional<Placing>> placings(9, Placing{{1, 0, 5, 0, 1, 5}});
  placings[4].reset();
  for (std::size_t i = 5; i < 9; ++i) placings[i]->m[2] = 100;
  const auto smooth = Smoothed(placings);
  EXPECT_FALSE(smooth[4]);
  EXPECT_FLOAT_EQ(smooth[3]->m[2], 5);
  EXPECT_FLOAT_EQ(smooth[5]->m[2], 100);
  placings[1]->m[2] = 7;
  const float middle = Smoothed(placings)[1]->m[2];
  EXPECT_TRUE(middle > 5 && middle < 6.5F) << middle;
}

}  // namespace
}  // namespace filmdub
