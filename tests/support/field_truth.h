// The bakers' truth about the world field, as tests call it.
#pragma once

#include "bakers/field_truth.h"

namespace brickfield::test {

using brickfield::FieldOracle;
using brickfield::FieldTruth;

} // namespace brickfield::test
