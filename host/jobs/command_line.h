/* The command line as one text that a shell would read back as it was. */
#ifndef EC_JOBS_COMMAND_LINE_H
#define EC_JOBS_COMMAND_LINE_H

/* malloc'ed, the caller's; NULL when out of memory. */
char *ec_command_line(int argc, char **argv);

#endif
