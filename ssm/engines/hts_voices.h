#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// Several voice files of one kind in hts_engine, spoken as one voice between them. From
/// full-context labels the durations come first (about a millisecond), sound when it is asked for.
/// Thread: calls from several threads wait for one another.
class HtsVoices {
 public:
  struct How {
    std::vector<double> weights{};  ///< one for each file, not negative, sum 1
    double speed = 1;
    double half_tones = 0;
  };
  /// Errors: kUnavailable or kBadValue with the file's name. REQUIRES: at least one file; no other
  /// thread is in the middle of an allocation (the files are tried in a child of this process).
  static vm::Result<std::unique_ptr<HtsVoices>> Load(const std::vector<std::string>& files);
  ~HtsVoices();
  HtsVoices(const HtsVoices&) = delete;
  HtsVoices& operator=(const HtsVoices&) = delete;

  /// The instants at which the labels' phonemes end. Error: kUnavailable.
  vm::Result<std::vector<Millis>> Ends(const std::vector<std::string>& labels, const How& how);
  /// The sound, 16 kHz; as long as the last of Ends. Error: kUnavailable.
  vm::Result<std::vector<std::int16_t>> Sound(const std::vector<std::string>& labels,
                                              const How& how);

 private:
  struct Library;
  explicit HtsVoices(std::unique_ptr<Library> library);
  vm::Result<std::vector<Millis>> States(const std::vector<std::string>& labels, const How& how);
  std::mutex mutex_;
  const std::unique_ptr<Library> library_;  // guarded by mutex_
};

}  // namespace ssm
