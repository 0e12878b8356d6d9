"""Threads of YARP."""

import time

import yarp


class Worker(yarp.Thread):
    def threadInit(self):
        print("init")
        return True

    def run(self):
        print("run")
        while not self.isStopping():
            time.sleep(0.01)

    def threadRelease(self):
        print("release")


worker = Worker()
print(worker.isRunning(), worker.start(), worker.isRunning())
time.sleep(0.2)
print(worker.stop(), worker.isRunning())


class Never(yarp.Thread):
    def threadInit(self):
        return False

    def run(self):
        print("not run")


print(Never().start())
semaphore = yarp.Semaphore(1)
print(semaphore.check(), semaphore.check(), semaphore.waitWithTimeout(0.05))
semaphore.post()
semaphore.wait()
