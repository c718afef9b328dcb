// Pictures with something to read on them: screens, posters, labels, signs. 8-bit BGR.
#pragma once

#include <opencv2/core.hpp>

namespace waretwin::builder {

cv::Mat draw_status_screen();           // 16:9, a cell's control panel
cv::Mat draw_code_screen();             // 16:9, an editor
cv::Mat draw_plot_screen();             // 16:9, curves
cv::Mat draw_safety_poster();           // A1 upright
cv::Mat draw_project_poster();          // A0 upright
cv::Mat draw_lifting_poster();          // A1 upright
cv::Mat draw_whiteboard();              // 3:2
cv::Mat draw_exit_sign();               // 2:1
cv::Mat draw_type_label();              // 2:1, a machine's type plate
cv::Mat draw_parcel_label();            // 2:3
cv::Mat draw_warning_label();           // square
cv::Mat draw_station_sign(int number);  // square
cv::Mat draw_clock();                   // square
cv::Mat draw_keyboard();                // 3:1
cv::Mat draw_checkerboard();            // 80:59, 10 x 7 squares with a white border of 5/7 square

}  // namespace waretwin::builder
