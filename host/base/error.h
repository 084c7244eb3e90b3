/* Results and messages. Every function that can fail returns an ec_result and takes an ec_error last. */
#ifndef EC_BASE_ERROR_H
#define EC_BASE_ERROR_H

typedef enum ec_result {
    EC_OK = 0,
    EC_FAILED = 1, /* bad input, device or file: exit code 1 */
    EC_USAGE = 2   /* the command line is wrong: exit code 2 */
} ec_result;

/* The kinds of error that a caller may act on: by using less memory, or by keeping what was computed before. */
typedef enum ec_error_kind { EC_ERROR_OTHER, EC_ERROR_HOST_MEMORY, EC_ERROR_DEVICE_MEMORY, EC_ERROR_DEVICE } ec_error_kind;

/* One line: what went wrong, where, and how to mend it. No trailing newline. */
typedef struct ec_error {
    char text[2048];
    ec_error_kind kind;
} ec_error;

/* Formats the message into err (which may be NULL) and returns EC_FAILED. The kind becomes EC_ERROR_OTHER. */
ec_result ec_fail(ec_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Appends to the message; the kind stays. */
void ec_fail_more(ec_error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Forwards a failure; use where nothing needs to be released. */
#define EC_TRY(call)                                                                               \
    do {                                                                                           \
        ec_result ec_try_result = (call);                                                          \
        if (ec_try_result != EC_OK) return ec_try_result;                                          \
    } while (0)

/* Forwards a failure to the function's `cleanup:` label through a local named `result`. */
#define EC_TRY_CLEANUP(call)                                                                       \
    do {                                                                                           \
        result = (call);                                                                           \
        if (result != EC_OK) goto cleanup;                                                         \
    } while (0)

/* The receiver of messages; zero-initialised: none. `text` has no newline. */
typedef enum ec_severity {
    EC_STATUS,  /* what is being done */
    EC_NOTE,
    EC_WARNING,
    EC_FAILURE  /* of a part, such as one frame of many; failures of the whole are ec_errors */
} ec_severity;
typedef struct ec_log {
    void (*write)(void *user, ec_severity severity, const char *text);
    void *user;
} ec_log;

/* log may be NULL. */
void ec_tell(const ec_log *log, ec_severity severity, const char *format, ...) __attribute__((format(printf, 3, 4)));
#define ec_say(log, ...) ec_tell(log, EC_STATUS, __VA_ARGS__)
#define ec_note(log, ...) ec_tell(log, EC_NOTE, __VA_ARGS__)
#define ec_warn(log, ...) ec_tell(log, EC_WARNING, __VA_ARGS__)

#endif
