#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "face_fit/find/face_networks.h"

namespace facefit {

/// A test that needs the networks that find faces; it skips with their message where they are not.
class NetworkTest : public testing::Test {
 protected:
  void SetUp() override {
    auto loaded = FaceNetworks::Load("");
    if (!loaded) GTEST_SKIP() << loaded.error().text;
    networks_.emplace(std::move(*loaded));
  }
  std::optional<FaceNetworks> networks_;
};

}  // namespace facefit
