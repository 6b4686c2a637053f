# Read by cpack when it makes the package: what the programs need is known when they are linked.
file(GLOB programs ${CPACK_DMISE_BINARY_DIR}/bin/dmise* ${CPACK_DMISE_BINARY_DIR}/lib/libdmise_*.so)
execute_process(COMMAND ${CPACK_DMISE_SOURCE_DIR}/launch/package/needed.sh ${programs}
                OUTPUT_VARIABLE needed OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ", " CPACK_DEBIAN_PACKAGE_DEPENDS "${needed}")
