#pragma once

#include <cstdint>
#include <string>

#include "framework/files/Hdf5.hpp"

namespace kiln::hdf5 {

/// A new file, as File::create() makes, for which the disk has set aside `bytes` first: a full disk is told before HDF5
/// begins to write, which it does not survive well. Throws FileError. Collective.
File create_with_room(const std::string& path, std::uint64_t bytes,
                      const Teuchos::RCP<const Communicator>& communicator);

/// Whether HDF5 failed to write a file in this process. It then cannot close that file, and crashes when the process
/// ends in the usual way.
bool writing_failed();
/// Said by the HDF5 layer.
void note_failed_writing();

}  // namespace kiln::hdf5
