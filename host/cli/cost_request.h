/* What `eclat cost` was asked for. */
#ifndef EC_CLI_COST_REQUEST_H
#define EC_CLI_COST_REQUEST_H

#include "jobs/render_request.h"

typedef struct ec_cost_request {
    ec_render_request render;  /* first: the setters of its options are used. Scene, camera, environment, device, size, seed; no outputs */
    double budget;             /* seconds */
    const char *html, *json;   /* files; NULL: none; json may be "-" */
    const char *reference;     /* file, or NULL */
} ec_cost_request;

int ec_cost_rows(ec_option *rows); /* its options; returns their number */
ec_result ec_cost_request_parse(int argc, char **argv, ec_cost_request *request, ec_request *asked, ec_error *err);

#endif
