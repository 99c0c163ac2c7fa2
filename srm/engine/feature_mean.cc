#include "srm/engine/feature_mean.h"

#include <sphinxbase/cmn.h>
#include <sphinxbase/feat.h>

#include <cstddef>

namespace srm {
namespace {

// Frames of 10 ms that the sound before counts as; the library's own figure (CMN_WIN).
constexpr float kWeight = 500;

cmn_t* MeanOf(ps_decoder_t* decoder) { return ps_get_feat(decoder)->cmn_struct; }

}  // namespace

FeatureMean::FeatureMean(ps_decoder_t* decoder) : decoder_(decoder) {
  const cmn_t* mean = MeanOf(decoder_);
  all_.assign(mean->cmn_mean, mean->cmn_mean + mean->veclen);
  own_ = all_;
}

void FeatureMean::Begin() {
  cmn_t* mean = MeanOf(decoder_);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    mean->cmn_mean[i] = all_[i];
    mean->sum[i] = 0;
  }
  mean->nframe = 0;
}

void FeatureMean::End() {
  const cmn_t* mean = MeanOf(decoder_);
  if (mean->nframe > 0) {
    const auto frames = static_cast<float>(mean->nframe);
    for (std::size_t i = 0; i < all_.size(); ++i) {
      own_[i] = mean->sum[i] / frames;
      all_[i] = (kWeight * all_[i] + frames * own_[i]) / (kWeight + frames);
    }
  }
  UseAll();
}

void FeatureMean::Forget() { UseAll(); }
void FeatureMean::UseOwn() { Set(own_); }
void FeatureMean::UseAll() { Set(all_); }

void FeatureMean::Set(const std::vector<float>& mean) {
  std::vector<float> values = mean;
  cmn_live_set(MeanOf(decoder_), values.data());
}

}  // namespace srm
