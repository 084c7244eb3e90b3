# Runs before cpack packs the installed files: makes them conform to Debian's policy.

# `cmake --install` uses file(RPATH_REMOVE) too.
function(forget_search_paths folder)
  file(GLOB programs ${folder}/usr/bin/* ${folder}/usr/lib/libeclat.so.* ${folder}/usr/lib/eclat/*)
  foreach(file ${programs})
    if(NOT IS_SYMLINK ${file})
      file(RPATH_REMOVE FILE ${file})
    endif()
  endforeach()
endfunction()

function(compress file)
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(write_debian_documents folder package)
  set(documents ${folder}/usr/share/doc/${package})
  file(STRINGS ${CPACK_ECLAT_SOURCE}/CHANGELOG.md heading REGEX "^## [0-9]" LIMIT_COUNT 1)
  string(REGEX REPLACE ".* ([-0-9]+)$" "\\1" day "${heading}")
  execute_process(COMMAND date -u -R -d ${day} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${documents}/changelog.Debian "eclat (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
       "  * This version. What changed in it is in changelog.gz of eclat.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  compress(${documents}/changelog.Debian)
  file(WRITE ${documents}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: eclat\n\nFiles: *\n"
       "Copyright: 2026 the authors of eclat\nLicense: Apache-2.0\n On Debian systems the text is in /usr/share/common-licenses/Apache-2.0.\n")
endfunction()

function(prepare_debian component)
  set(folder ${CPACK_TEMPORARY_DIRECTORY}/${component})
  string(TOUPPER ${component} upper)
  forget_search_paths(${folder})
  write_debian_documents(${folder} ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  if(component STREQUAL program)
    file(COPY_FILE ${CPACK_ECLAT_SOURCE}/CHANGELOG.md ${folder}/usr/share/doc/eclat/changelog)
    compress(${folder}/usr/share/doc/eclat/changelog)
    compress(${folder}/usr/share/man/man1/eclat.1)
    file(RENAME ${folder}/usr/share/zsh/site-functions ${folder}/usr/share/zsh/vendor-completions)
  endif()
endfunction()

if(CPACK_GENERATOR STREQUAL DEB)
  foreach(component ${CPACK_COMPONENTS_ALL})
    prepare_debian(${component})
  endforeach()
endif()
