#pragma once

#include <pocketsphinx.h>

#include <vector>

/// Private to srm/engine.
namespace srm {

/// What room, microphone and steady noise add to all sound: the mean of its features (cepstra),
/// which is taken out before they are compared with the model's. While an utterance comes in only
/// that of the sound before it is known; afterwards its own is known too, for another look.
/// Lifetime: the decoder outlives it.
class FeatureMean {
 public:
  explicit FeatureMean(ps_decoder_t* decoder);
  /// Before an utterance is started.
  void Begin();
  /// After an utterance has ended: its own mean becomes part of the mean of all.
  void End();
  /// The same, but it counts for nothing.
  void Forget();
  /// For what is decoded next: the last utterance's own.
  void UseOwn();
  /// Back again; for the utterances to come.
  void UseAll();

 private:
  void Set(const std::vector<float>& mean);
  ps_decoder_t* const decoder_;
  std::vector<float> all_, own_;
};

}  // namespace srm
