# Downloads URL to FILE unless it is there with the checksum SUM (SHA-256).
file(DOWNLOAD ${URL} ${FILE} EXPECTED_HASH SHA256=${SUM} STATUS status)
list(GET status 0 code)
if(code)
  message(FATAL_ERROR "${URL}: ${status}")
endif()
