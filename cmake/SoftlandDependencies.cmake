# What the libraries need, for the build and for whoever links the installed ones (softlandConfig.cmake). Debian 12 packages; see the
# launcher for their names. softland_find is find_package(... REQUIRED) or find_dependency.
softland_find(Eigen3 3.4 NO_MODULE)
softland_find(SUNDIALS 6.4)
softland_find(NLopt 2.7)
softland_find(PkgConfig)
if(NOT TARGET PkgConfig::IPOPT)
  pkg_check_modules(IPOPT REQUIRED IMPORTED_TARGET ipopt)
endif()
softland_find(fmt)
softland_find(nlohmann_json)
softland_find(tomlplusplus)
softland_find(Boost 1.74)
softland_find(Threads)
