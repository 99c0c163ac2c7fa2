#include "hypermask/sim/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "face_track/film/picture_source.h"
#include "fsm/film/film_writer.h"
#include "hypermask/follow/mask_follower.h"
#include "hypermask/project/face_warp.h"
#include "hypermask/sim/trial.h"
#include "vm_protocol/core/or_throw.h"

namespace hypermask {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFilmRate = 30;
constexpr double kCameraField = 33;

/// The face's pictures at their times, again from the beginning after the last.
class FaceFilm {
 public:
  explicit FaceFilm(std::string name) : name_(std::move(name)) {
    Open();
    if (!Next()) throw std::runtime_error("'" + name_ + "' has no picture");
  }
  const fsm::Image& At(double ms) {
    while (next_ && begun_ms_ + next_->ms <= ms) {
      now_ = next_->picture;
      last_ms_ = next_->ms;
      if (!Next()) {
        // The last picture is shown as long as the others.
        constexpr double kPictureMs = 40;
        begun_ms_ += last_ms_ + kPictureMs;
        Open();
        Next();
      }
    }
    return now_;
  }

 private:
  void Open() { source_ = vm::OrThrow(facetrack::OpenPictures(name_, kFilmRate)); }
  bool Next() {
    next_.emplace();
    if (!vm::OrThrow(source_->Next(*next_))) next_.reset();
    return next_.has_value();
  }
  const std::string name_;
  std::unique_ptr<facetrack::PictureSource> source_;
  std::optional<facetrack::TimedPicture> next_;
  fsm::Image now_;
  double begun_ms_ = 0, last_ms_ = 0;
};

/// One half of the film: the mask followed and the face projected in one way.
class Half {
 public:
  Half(const Stage& stage, const Calibration& calibration, Prediction prediction,
       const SimSettings& settings)
      : stage_(stage),
        calibration_(calibration),
        settings_(settings),
        follower_(stage.layout, {.prediction = prediction,
                                 .ahead = settings.delay_ms / 1000 + 0.5 / settings.rate}),
        warp_(stage.layout, stage.projector.lens.width, stage.projector.lens.height),
        lit_(fsm::FilledImage(stage.projector.lens.width, stage.projector.lens.height,
                              fsm::kBlack)) {}

  /// A picture of the camera, and the face as it is then.
  void Look(const Grey& picture, double now, const fsm::Image& face, const Pose& truth_when_lit) {
    follower_.Look(picture, now);
    const double lit = now + settings_.delay_ms / 1000;
    const auto markers = follower_.At(lit + 0.5 / settings_.rate);
    const auto map = markers ? MaskToProjector(calibration_, Form::kSpace, stage_.layout, *markers)
                             : std::nullopt;
    warp_.SetFace(face);
    Waiting waiting{.lit = lit, .frame = warp_.Draw(map ? &*map : nullptr)};
    if (map) {
      for (const double miss : LandingDistances(stage_, *map, truth_when_lit)) {
        waiting.miss += miss * miss / 5;
      }
    }
    waiting_.push_back(std::move(waiting));
  }
  const fsm::Image& Lit(double now) {
    constexpr double kMemory = 0.1;  // of the shown error
    while (!waiting_.empty() && waiting_.front().lit <= now + 1e-9) {
      lit_ = std::move(waiting_.front().frame);
      miss_ += kMemory * (waiting_.front().miss - miss_);
      waiting_.pop_front();
    }
    return lit_;
  }
  double miss() const { return std::sqrt(miss_); }

 private:
  struct Waiting {
    double lit;
    fsm::Image frame;
    double miss = 0;
  };
  const Stage& stage_;
  const Calibration& calibration_;
  const SimSettings settings_;
  MaskFollower follower_;
  FaceWarp warp_;
  fsm::Image lit_;
  std::deque<Waiting> waiting_;  // as many as are taken during the delay
  double miss_ = 0;
};

void Write(cv::Mat& picture, const std::string& text, int x, int y, double size) {
  const cv::Point at(x, y);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_DUPLEX, size, cv::Scalar(0, 0, 0, 255), 3,
              cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_DUPLEX, size, cv::Scalar(225, 225, 225, 255), 1,
              cv::LINE_AA);
}

}  // namespace

void MakeStageFilm(const StageFilm& wanted) {
  Stage stage;
  stage.audience = Viewpoint::LookingAt(Pinhole::OfField(kWidth / 2, kHeight, 31),
                                        {-300, -120, 100}, {0, 60, 2000});
  const Calibration calibration = vm::OrThrow(CalibrateStage(stage, 6, kCameraField));
  const StageCamera camera(stage);
  const StageView view(stage);
  FaceFilm face(wanted.face);
  const auto movie = vm::OrThrow(fsm::FilmWriter::Open(wanted.out, kWidth, kHeight, kFilmRate));
  fsm::Image frame = fsm::FilledImage(kWidth, kHeight, fsm::kBlack), seen;
  cv::Mat canvas(kHeight, kWidth, CV_8UC4, frame.rgba.data());
  Grey picture;
  double film_ms = 0;
  for (const SimSettings& scene : wanted.scenes) {
    const Movement movement(scene.movement, scene.seed);
    Half plain(stage, calibration, Prediction::kOff, scene);
    Half foretold(stage, calibration, Prediction::kBank, scene);
    // It moves for a second before it is seen.
    const double lead = 1;
    std::uint32_t number = 0;
    const auto frames = static_cast<int>((wanted.scene_seconds + lead) * kFilmRate);
    for (int f = 0; f < frames; ++f) {
      const double now = static_cast<double>(f) / kFilmRate;
      const bool shown = now >= lead;
      const fsm::Image& talking = face.At(film_ms);
      while (number / scene.rate <= now + 1e-9) {
        const double taken = number / scene.rate;
        camera.See(movement.At(taken - stage.exposure_s / 2),
                   movement.At(taken + stage.exposure_s / 2), number, CoveredMarkers(scene, taken),
                   nullptr, picture);
        const Pose truth = movement.At(taken + scene.delay_ms / 1000 + 0.5 / scene.rate);
        plain.Look(picture, taken, talking, truth);
        foretold.Look(picture, taken, talking, truth);
        ++number;
      }
      const Pose mask = movement.At(now);
      for (Half* const half : {&plain, &foretold}) {
        const fsm::Image& lit = half->Lit(now);
        if (!shown) continue;
        view.See(mask, lit, seen);
        const int x = half == &plain ? 0 : kWidth / 2;
        cv::Mat(seen.height, seen.width, CV_8UC4, seen.rgba.data())
            .copyTo(canvas(cv::Rect(x, 0, kWidth / 2, kHeight)));
        Write(canvas, half == &plain ? "without prediction" : "with prediction", x + 24, 44, 0.9);
        Write(canvas, fmt::format("off by {:.1f} px", half->miss()), x + 24, kHeight - 28, 0.8);
      }
      if (!shown) continue;
      cv::line(canvas, {kWidth / 2, 0}, {kWidth / 2, kHeight}, cv::Scalar(0, 0, 0, 255), 4);
      Write(canvas,
            fmt::format("{}, {:g} ms of delay", Movement::NameOf(scene.movement), scene.delay_ms),
            kWidth / 2 + 24, kHeight - 64, 0.8);
      vm::OrThrow(movie->Add(frame));
      film_ms += 1000.0 / kFilmRate;
    }
  }
  vm::OrThrow(movie->Finish(wanted.sound));
}

}  // namespace hypermask
