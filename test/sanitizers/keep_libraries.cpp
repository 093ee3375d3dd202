// SPDX-License-Identifier: BSD-3-Clause
// OpenNI2 and its own drivers stay loaded until the end of the process: only then can LeakSanitizer tell that the
// memory is theirs (lsan.supp). OpenNI2 loads and unloads its drivers with every first and last user. The virtual depth
// camera, a driver of ours, is unloaded as ever: what it leaves is a finding.
#include <dlfcn.h>
#include <link.h>

#include <array>
#include <cstring>

extern "C" int dlclose(void* handle) {
  constexpr std::array<const char*, 2> kKept = {"/libOniFile.so", "/libDummyDevice.so"};
  const link_map* map = nullptr;
  if (dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr) {
    for (const char* name : kKept) {
      if (std::strstr(map->l_name, name) == nullptr) continue;
      dlopen("libOpenNI2.so.0", RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
      return 0;
    }
  }
  return reinterpret_cast<int (*)(void*)>(dlsym(RTLD_NEXT, "dlclose"))(handle);
}
