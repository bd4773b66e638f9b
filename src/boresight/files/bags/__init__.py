"""ROS 2 bags without ROS: what is in the files, as far as it can be read, and what is lost."""

from boresight.files.bags.bag import Bag as Bag
from boresight.files.bags.bag import Topic as Topic
from boresight.files.bags.bag import read_bag as read_bag
from boresight.files.bags.storages import is_bag as is_bag
