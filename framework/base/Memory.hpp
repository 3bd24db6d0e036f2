#pragma once

namespace kiln {

/// Bytes of this machine's memory: what asks for more cannot be meant.
double machine_memory();

}  // namespace kiln
