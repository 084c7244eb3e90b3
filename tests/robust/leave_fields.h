/* Results of leave.cl about rays that leave surfaces: fields of a queue. */
#ifndef EC_TESTS_ROBUST_LEAVE_FIELDS_H
#define EC_TESTS_ROBUST_LEAVE_FIELDS_H

enum ec_leave_field {
    EC_LEAVE_P,              /* x, y, z */
    EC_LEAVE_ERROR = 3,      /* error bound for each axis */
    EC_LEAVE_AGAIN = 6,      /* 1: the ray meets the triangle that it leaves */
    EC_LEAVE_FIELDS
};

#endif
