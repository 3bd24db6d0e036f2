# Run when a header changed: writes Kiln's version and the hash of all headers, with their names, as C++ text.
file(READ ${HEADERS} headers)
set(hashes)
foreach(header IN LISTS headers)
  file(SHA256 ${SOURCE_DIR}/${header} hash)
  string(APPEND hashes "${header} ${hash}\n")
endforeach()
string(SHA256 INTERFACE "${hashes}")
string(SUBSTRING ${INTERFACE} 0 12 INTERFACE)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [=[
#pragma once

#define KILN_VERSION "@VERSION@"
#define KILN_INTERFACE "@INTERFACE@"
]=] @ONLY)
