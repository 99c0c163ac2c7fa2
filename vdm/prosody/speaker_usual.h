#pragma once

namespace vdm {

/// Mean and deviation of what came so far, on the fly: they start from what is usual among people
/// and move to what comes, with a bounded memory. A plain value.
class RunningMean {
 public:
  struct Prior {
    double mean = 0, deviation = 1;
    double mean_weight = 1;  ///< as if so many values had been as usual
    double deviation_weight = 1;
    double memory = 1000;  ///< values; older ones fade
  };
  explicit RunningMean(const Prior& prior)
      : prior_(prior), mean_(prior.mean), deviation_(prior.deviation) {}

  void Add(double value);
  double mean() const { return mean_; }
  double deviation() const { return deviation_; }
  double weight() const { return weight_; }  ///< of what came, in values
  /// How far `value` is above the mean, in deviations.
  double Above(double value) const { return (value - mean_) / deviation_; }

 private:
  Prior prior_;
  double weight_ = 0;
  double sum_ = 0, squares_ = 0;  // weighted; squares about the mean of their time
  double mean_, deviation_;
};

/// How somebody usually speaks, by what was heard of the voice so far. Of each speaker there is
/// one: what is high, loud or quick is so beside the speaker's own voice. A plain value.
struct SpeakerUsual {
  SpeakerUsual();
  RunningMean log_hz;    ///< natural logarithm, of voiced instants
  RunningMean power_db;  ///< of voiced instants
  RunningMean tilt_db;   ///< of voiced instants
  RunningMean rate;      ///< syllables a second, of phrases
};

}  // namespace vdm
