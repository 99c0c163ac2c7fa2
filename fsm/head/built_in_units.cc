#include "fsm/head/built_in_units.h"

#include "embedded/action_units.h"

namespace fsm {

const UnitTable& BuiltInUnits() {
  static const UnitTable units(Table("tables/action_units.txt", embedded::action_units()));
  return units;
}

}  // namespace fsm
