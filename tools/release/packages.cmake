# `cpack` makes these in the build folder:
#   cpack -G DEB   eclat, eclat-mpi, eclat-view and libeclat-dev, for the Debian that they are built on
#   cpack -G TGZ   all but eclat-mpi in one archive, with the libraries that a bare system lacks
set(ECLAT_MAINTAINER "eclat maintainers <maintainers@eclat.example>" CACHE STRING "Who answers for the packages, with an address")
set(CPACK_PACKAGE_VENDOR eclat)
set(CPACK_PACKAGE_CONTACT ${ECLAT_MAINTAINER})
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/generator.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/before_packing.cmake)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_ECLAT_SOURCE ${PROJECT_SOURCE_DIR})

set(CPACK_PACKAGE_FILE_NAME eclat-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
string(TOLOWER "${CPACK_PACKAGE_FILE_NAME}" CPACK_PACKAGE_FILE_NAME)

# Debian packages; dpkg-shlibdeps finds their dependencies.
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}) # libeclat, which the modules need
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)

# eclat_package(component name section summary lines...); the lines say what it holds.
function(eclat_package component name section summary)
  string(TOUPPER ${component} upper)
  list(JOIN ARGN "\n" lines)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\neclat renders a glTF 2.0 scene to a physically based image with a stated\nerror, on any OpenCL device.\n.\n${lines}" PARENT_SCOPE)
  if(NOT component STREQUAL program)
    set(CPACK_COMPONENT_${upper}_DEPENDS program PARENT_SCOPE)
  endif()
endfunction()
eclat_package(program eclat graphics "physically based renderer of glTF scenes with a stated error"
              "This package has the program and its library.")
eclat_package(dev libeclat-dev libdevel "physically based renderer of glTF scenes - development files"
              "This package has the header and the static library.")
eclat_package(mpi eclat-mpi graphics "physically based renderer of glTF scenes - MPI"
              "This package lets the processes that mpirun starts share a picture.")
eclat_package(view eclat-view graphics "physically based renderer of glTF scenes - window"
              "This package has the interactive window of 'eclat view'.")

# For other packages that link the library, and for the loader's cache.
file(WRITE ${CMAKE_BINARY_DIR}/debian/shlibs "libeclat ${PROJECT_VERSION_MAJOR} eclat (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/debian/shlibs ${CMAKE_BINARY_DIR}/debian/triggers)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS "openmpi-bin")

set(CPACK_COMPONENTS_ALL program dev)
foreach(component mpi view)
  if(TARGET eclat_${component})
    list(APPEND CPACK_COMPONENTS_ALL ${component})
  endif()
endforeach()

# The archive contains the linked libraries, except those that every system of its age has. Drivers bring these too, and a process must not load two
# copies of one.
if(NOT CMAKE_CROSSCOMPILING)
  set(of_the_system "^ld-linux" "^lib(c|m|dl|rt|pthread|gcc_s|stdc\\+\\+|z|X[a-z0-9]*|xcb.*|GL[A-Za-z]*|EGL|eclat)\\.so")
  foreach(set program_needs view_needs)
    if(set STREQUAL program_needs OR TARGET eclat_view)
      install(RUNTIME_DEPENDENCY_SET ${set} PRE_EXCLUDE_REGEXES ${of_the_system} DESTINATION ${module_folder} COMPONENT bundle EXCLUDE_FROM_ALL)
    endif()
  endforeach()
  install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/bundle.cmake COMPONENT bundle EXCLUDE_FROM_ALL)
  install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT bundle EXCLUDE_FROM_ALL)
endif()
include(CPack)
