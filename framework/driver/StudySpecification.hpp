#pragma once

#include "framework/registry/Specification.hpp"

namespace kiln {

/// The keys of a study file: what `kiln study` reads.
Specification study_specification();

/// Keys of a case in study.json, which no placeholder may be named by.
const std::vector<std::string>& study_columns();

}  // namespace kiln
