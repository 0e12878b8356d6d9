"""Threads of YARP."""

import time

import yarp

notes = []


class Worker(yarp.Thread):
    def threadInit(self):
        notes.append("init")
        return True

    def run(self):
        notes.append("run")
        while not self.isStopping():
            time.sleep(0.01)

    def threadRelease(self):
        notes.append("release")


worker = Worker()
print(worker.isRunning(), worker.start(), worker.isRunning())
while "run" not in notes:
    time.sleep(0.01)
print(worker.stop(), worker.isRunning(), notes)


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
