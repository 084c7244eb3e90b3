/* The page of the report, embedded at build time from cost/page/ and Chart.js (Debian's libjs-chart.js). */
#ifndef EC_COST_PAGE_H
#define EC_COST_PAGE_H

extern const char ec_text_page_html[]; /* with placeholders @STYLE@, @TEXT@, @DATA@, @IMAGES@, @CHART@, @SCRIPT@ */
extern const char ec_text_page_css[];
extern const char ec_text_page_js[];
extern const char ec_text_chart_js[];

#endif
