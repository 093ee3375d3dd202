#error "The core must not include ROS: put this code into the ros layer."
