#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "vm_protocol/core/or_throw.h"

namespace facefit {

/// A test that needs the networks that find faces; it skips with their message where they are not.
/// They and the built-in head as they see it are shared by the tests of a suite, which do not
/// change them: what a network is shown last leaves nothing in it.
class NetworkTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto loaded = FaceNetworks::Load("");
    missing_ = loaded ? "" : loaded.error().text;
    if (loaded) networks_.emplace(std::move(*loaded));
  }
  static void TearDownTestSuite() {
    base_.reset();
    networks_.reset();
  }
  void SetUp() override {
    if (!networks_) GTEST_SKIP() << missing_;
  }
  static const ObservedHead& Galatea() {
    if (!base_) base_.emplace(vm::OrThrow(ObservedHead::BuiltIn(*networks_, "galatea")));
    return *base_;
  }

  static inline std::optional<FaceNetworks> networks_;

 private:
  static inline std::string missing_;
  static inline std::optional<ObservedHead> base_;
};

/// A test that needs the finer network of landmarks, too.
class AttentionNetworkTest : public NetworkTest {
 protected:
  void SetUp() override {
    NetworkTest::SetUp();
    if (!networks_) return;
    auto loaded = AttentionNetwork::Load("");
    ASSERT_TRUE(loaded) << loaded.error().text;
    attention_.emplace(std::move(*loaded));
  }
  std::optional<AttentionNetwork> attention_;
};

}  // namespace facefit
