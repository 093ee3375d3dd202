// SPDX-License-Identifier: BSD-3-Clause
// OpenNI2 and its drivers stay loaded until the end of the process: only then can LeakSanitizer tell that
// the memory is theirs. OpenNI2 loads and unloads its drivers with every first and last user.
#include <dlfcn.h>
#include <link.h>

#include <cstring>

extern "C" int dlclose(void* handle) {
  const link_map* map = nullptr;
  if (dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr && strcasestr(map->l_name, "/drivers/") != nullptr) {
    dlopen("libOpenNI2.so.0", RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
    return 0;
  }
  return reinterpret_cast<int (*)(void*)>(dlsym(RTLD_NEXT, "dlclose"))(handle);
}
