"""Sound: samples, channels, silence."""

import yarp

s = yarp.Sound()
print(s.getSamples(), s.getChannels(), s.getBytesPerSample())
s.setFrequency(16000)
s.resize(4, 2)
for channel in range(2):
    for sample in range(4):
        s.set(10 * channel + sample, sample, channel)
print(s.get(1), s.get(2, 1), s.get(0), s.getSamples(), s.getChannels(), s.getFrequency())
print(repr(s.toString_c()), s.isSample(9), s.isSample(3, 1), s.getSafe(99))
s.setSafe(5, 99)
print(s.isEqual(yarp.Sound(s)), s.extractChannelAsSound(1).getChannels())
print(list(s.sound2VecInterleaved()), list(s.sound2VecNonInterleaved()))
print(s.subSound(0, 2).getSamples())
s.clear()
print(s.getSamples(), s.get(1))
s.resize(3)
print(s.getSamples(), s.getChannels())
