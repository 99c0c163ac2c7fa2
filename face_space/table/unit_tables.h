#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "face_space/eigen/eigen_units.h"
#include "face_space/place/placement.h"
#include "face_space/table/row_fit.h"
#include "vm_protocol/core/result.h"

namespace facespace {

/// A shape that is to become a unit of fsm.
struct ShapeUnit {
  std::string name;
  Eigen::VectorXd moves;  ///< 3 markers: mm at strength 1, in the frame and size of the recordings
};
/// What became of it.
struct WrittenUnit {
  std::string name;
  int number = 0;          ///< of the first part
  std::string in_command;  ///< as `set AU` and expressions take it: `801`, or `801L 802R`
  std::vector<RowFitter::Part> parts;
  Missing
      missing;  ///< how far the head's markers lie elsewhere than the shape says, mm on the head
};

/// Tables of units by file name, with what they had before and the new units.
struct UnitTables {
  std::map<std::string, std::string> files;
  std::vector<WrittenUnit> units;
};
/// Where new units get their numbers, and what the tables were before.
struct TableBase {
  std::string folder = "";  ///< of tables; "" and tables that it has not: those fsm carries
  int first_number = 801;
};
/// Writes shapes as units into copies of action_units.txt, action_unit_names.txt and
/// action_unit_list.txt. All together may have as many rows as fsm reads; they share what the
/// tables leave. Errors: kBadValue for names or numbers that are taken, kLimit if there is no room
/// for five rows a unit or no number left, those of reading tables.
vm::Result<UnitTables> WriteUnits(const std::vector<ShapeUnit>& shapes, const Placement& placement,
                                  const fsm::Head& head, const TableBase& base);

/// The text of a table that is to be changed: `folder`/`file` where there is one, else what is
/// built in. Errors: those of fsm::ReadTableFile.
vm::Result<std::string> BaseTable(const std::string& folder, const char* file,
                                  std::string_view built_in);

}  // namespace facespace
