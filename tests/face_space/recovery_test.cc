// The demonstration: a head of ours shows 52 mixtures of 11 units, with noise and with the head
// moving; the units are found again, become tables, and fsm's face moves by them as by its own.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "face_space/eigen/eigen_units.h"
#include "face_space/perform/performer.h"
#include "face_space/table/unit_tables.h"
#include "fsm/head/make_head.h"
#include "fsm/motion/inputs/motion_tables.h"

namespace facespace {
namespace {

double WorstOf(const Eigen::VectorXd& off) {
  double worst = 0;
  for (Eigen::Index m = 0; m < off.size(); m += 3)
    worst = std::max(worst, off.segment<3>(m).norm());
  return worst;
}
double RmsOf(const Eigen::VectorXd& off) {
  return std::sqrt(3 * off.squaredNorm() / static_cast<double>(off.size()));
}

/// All of it takes some seconds, so the tests share one.
struct Demonstration {
  std::unique_ptr<fsm::Head> head = fsm::MakeSymmetricHead("galatea");
  HeadSites sites = SitesOf(*head);
  std::vector<std::vector<Label>> labels = Mixtures(PaperUnits(), 52, *head, true, 1);
  StillFaces faces;
  EigenUnits eigen;
  std::vector<RecordedUnit> recorded;

  Demonstration() {
    std::vector<Recording> recordings;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      recordings.push_back(
          Perform({.rate = 40}, *head, sites, "take" + std::to_string(i), labels[i]));
    }
    faces = RemoveHeadMotion(recordings, {}).value();
    eigen = FindEigenUnits(faces, {.count = 11}, {.share = 0.99}).value();
    recorded = TakeApart(eigen, labels).value();
  }
  /// What a unit does by itself in the head's own rig.
  Eigen::VectorXd Truth(const std::string& unit) const {
    return SitesIn(*head, sites, StateOf({{unit, 1}})) - SitesIn(*head, sites, {});
  }
  static const Demonstration& Shared() {
    static const Demonstration demonstration;
    return demonstration;
  }
};

TEST(RecoveryTest, FiftyTwoDifferentMixturesOfElevenUnitsAreShown) {
  const auto& d = Demonstration::Shared();
  EXPECT_EQ(d.labels.size(), 52U);
  EXPECT_EQ(d.sites.vertices.size(), kPaperMarkers);
  EXPECT_EQ(d.eigen.performances.size(), 52U) << "each is found once";
  EXPECT_EQ(d.recorded.size(), 11U);
  for (const auto& mixture : d.labels) EXPECT_GE(mixture.size(), 2U) << "no unit is shown alone";
}

TEST(RecoveryTest, ElevenFaceVectorsKeepNearlyAllVariance) {
  const auto& d = Demonstration::Shared();
  double kept = 0;
  for (Eigen::Index k = 0; k < d.eigen.face.count(); ++k) kept += d.eigen.face.Share(k);
  RecordProperty("kept", std::to_string(kept));
  std::printf("variance kept by 11 vectors: %.4f; mm: moved %.2f, off %.3f, worst %.2f\n", kept,
              d.eigen.moved_mm, d.eigen.by_face.rms, d.eigen.by_face.worst);
  EXPECT_GT(kept, 0.98);
  EXPECT_LT(d.eigen.by_face.rms, 0.5);
}

TEST(RecoveryTest, EachUnitIsRecoveredFromMixturesWithinAMillimetre) {
  const auto& d = Demonstration::Shared();
  for (const RecordedUnit& unit : d.recorded) {
    const Eigen::VectorXd truth = d.Truth(unit.name);
    // The recordings' frame is that of the first's beginning: it turns back onto the head.
    const Placement placement = PlaceMarkers(d.faces.rest, d.sites.places, *d.head).value();
    const Eigen::VectorXd off = placement.OnHead(unit.moves) - truth;
    const Eigen::VectorXd in_space = d.eigen.face.vectors.transpose() * unit.moves;
    std::printf("unit %2s: moves %.2f mm at most %.2f; off %.3f at most %.2f\n", unit.name.c_str(),
                RmsOf(truth), WorstOf(truth), RmsOf(off), WorstOf(off));
    EXPECT_LT(RmsOf(off), 0.5) << unit.name;
    EXPECT_LT(WorstOf(off), 1) << unit.name;
  }
}

/// The tables of the recovered units in a folder, as fsm takes it.
class RecoveredTables {
 public:
  RecoveredTables() {
    const auto& d = Demonstration::Shared();
    EXPECT_NE(mkdtemp(folder_), nullptr);
    const Placement placement = PlaceMarkers(d.faces.rest, d.sites.places, *d.head).value();
    for (const double miss : placement.misses_mm) EXPECT_LT(miss, 1);
    std::vector<ShapeUnit> shapes;
    for (const RecordedUnit& unit : d.recorded)
      shapes.push_back({"Recorded" + unit.name, unit.moves});
    auto tables = WriteUnits(shapes, placement, *d.head, {});
    EXPECT_TRUE(tables) << tables.error().text;
    written = tables->units;
    for (const auto& [name, text] : tables->files)
      std::ofstream(std::filesystem::path(folder_) / name) << text;
  }
  ~RecoveredTables() { std::filesystem::remove_all(folder_); }
  std::string folder() const { return folder_; }
  std::vector<WrittenUnit> written;

 private:
  char folder_[40] = "/tmp/galatea_recovered_XXXXXX";
};

TEST(RecoveryTest, FsmReadsTheUnitsAndMovesItsFaceAsTheOriginalsDo) {
  const auto& d = Demonstration::Shared();
  const RecoveredTables tables;
  const auto motion = fsm::MotionTables::Load(tables.folder());
  ASSERT_TRUE(motion) << motion.error().text;
  const auto text = fsm::ReadTableFile(tables.folder() + "/action_units.txt");
  ASSERT_TRUE(text) << text.error().text;
  const auto head = d.head->WithUnits(fsm::UnitTable(fsm::Table("action_units.txt", *text)));
  for (const WrittenUnit& unit : tables.written) {
    const std::string original = unit.name.substr(8);
    ASSERT_TRUE(motion->unit_names.IsUnit(unit.number)) << unit.name;
    ASSERT_EQ(unit.parts.size(), 1U) << unit.name << " acts alike on both sides";
    const Eigen::VectorXd own =
        SitesIn(*head, d.sites, StateOf({{std::to_string(unit.number), 1}}));
    const Eigen::VectorXd truth = SitesIn(*head, d.sites, StateOf({{original, 1}}));
    // And all the skin of the face, between the markers, too.
    fsm::HeadVertices a, b;
    head->Evaluate(StateOf({{std::to_string(unit.number), 1}}), a);
    head->Evaluate(StateOf({{original, 1}}), b);
    double squares = 0, worst = 0, count = 0;
    for (const std::uint32_t i : FaceSkin(*head)) {
      const auto off = static_cast<double>(glm::distance(a.position[i], b.position[i]));
      squares += off * off;
      worst = std::max(worst, off);
      count += 1;
    }
    std::size_t rows = unit.parts[0].rows.rows();
    std::printf(
        "unit %2s in fsm: %2zu rows; markers off %.3f at most %.2f; all skin %.3f at most %.2f\n",
        original.c_str(), rows, RmsOf(own - truth), WorstOf(own - truth),
        std::sqrt(squares / count), worst);
    EXPECT_LT(RmsOf(own - truth), 0.6) << original;
    EXPECT_LT(WorstOf(own - truth), 2.5) << original;
  }
}

TEST(RecoveryTest, NamesNumbersAndRoomAreLookedAfter) {
  const auto& d = Demonstration::Shared();
  const Placement placement = PlaceMarkers(d.faces.rest, d.sites.places, *d.head).value();
  const ShapeUnit shape{"LidDroop", d.recorded[0].moves};
  const auto taken = WriteUnits({shape}, placement, *d.head, {});
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().text.find("LidDroop"), std::string::npos);
  EXPECT_FALSE(WriteUnits({{"A", shape.moves}, {"B", shape.moves}}, placement, *d.head,
                          {.first_number = 999}));
  EXPECT_FALSE(WriteUnits(std::vector<ShapeUnit>(400, shape), placement, *d.head, {}));
}

TEST(RecoveryTest, WhereMarkersLieMustBeKnown) {
  const auto& d = Demonstration::Shared();
  const auto placed = PlaceMarkers(d.faces.rest, {}, *d.head);
  ASSERT_FALSE(placed);
  EXPECT_NE(placed.error().text.find("--places"), std::string::npos);
  const auto by_name = PlacesByName({"Nasion", "cheilion_left", "33", "foo"}, *d.head);
  EXPECT_EQ(by_name.size(), 3U);
  EXPECT_EQ(by_name.find("33")->second, d.head->Landmark("exocanthion_right"));
  EXPECT_FALSE(ReadPlaces("p.txt", "place a nose_tip\n", *d.head));
  EXPECT_FALSE(ReadPlaces("p.txt", "place a 1 2\n", *d.head));
  EXPECT_TRUE(ReadPlaces("p.txt", "place a nasion\nplace b 1 2 3\n", *d.head));
}

TEST(RecoveryTest, AShapeOfOneSideBecomesRowsOfThatSide) {
  const auto& d = Demonstration::Shared();
  const Placement placement = PlaceMarkers(d.faces.rest, d.sites.places, *d.head).value();
  fsm::FaceState one;
  one.asymmetry = 0;
  one.au.right[12] = 1;
  const Eigen::VectorXd moves = SitesIn(*d.head, d.sites, one) - SitesIn(*d.head, d.sites, {});
  const RowFitter fitter(*d.head, placement.vertices);
  const auto parts = fitter.Fit(moves, 40);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_GT(parts[1].rows.rows(), parts[0].rows.rows()) << "the right side has more to do";
  const Missing missing = fitter.Check(parts, moves);
  EXPECT_LT(missing.rms, 0.4);
  EXPECT_LT(missing.worst, 1.5);
}

}  // namespace
}  // namespace facespace
